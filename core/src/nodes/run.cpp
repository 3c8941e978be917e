// Runs nodes: chooses the kernel of this processor and allocates memory for values.
#include "nodes/run.h"

#include "nodes/dispatch.h"
#include "nodes/vector_nodes.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <new>

namespace lancer {

const NodeKernel &node_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(node_kernel); }

namespace {

constexpr std::align_val_t kAlignment{64};

} // namespace

void *allocate_values(size_t bytes) { return ::operator new(bytes, kAlignment); }
void free_values(void *values) { ::operator delete(values, kAlignment); }

// The node machine at one hit.
namespace {

// moved: receives the instance as it is placed at the time of the surface, if it moves.
Site<float> site_of(const NodeContext &context, Instance &moved) {
  Site<float> site;
  site.scene = context;
  site.surface = context.surface != nullptr;
  site.wo = context.wo;
  site.footprint = context.footprint;
  site.eye[0] = context.eye;
  site.displaces = context.displaces;
  site.path = context.path;
  if (!context.surface) {
    // For the world only the direction is defined; its surface faces the viewer.
    site.number[0] = kNone;
    site.instance[0] = nullptr;
    site.place();
    site.primitive[0] = 0;
    site.time[0] = kMiddleTime;
    site.p = glm::dvec3(-glm::dvec3(context.wo));
    site.bary[0] = site.bary[1] = 0.0;
    site.ns = site.ng = context.wo;
    site.backfacing = false;
    return site;
  }
  const Surface &surface = *context.surface;
  site.instance[0] = context.geometry ? &context.geometry->placed_at(surface.instance, surface.time, moved) : nullptr;
  site.number[0] = surface.instance;
  site.time[0] = surface.time;
  site.place();
  site.primitive[0] = surface.primitive;
  site.p = surface.p;
  site.bary[0] = surface.bary.x;
  site.bary[1] = surface.bary.y;
  site.backfacing = glm::dot(surface.ng, context.wo) < 0.0f;
  site.ns = site.backfacing ? -surface.ns : surface.ns;
  site.ng = site.backfacing ? -surface.ng : surface.ng;
  return site;
}

} // namespace

void run(const ProgramView &program, ScheduleView schedule, const NodeContext &context, std::span<glm::vec4> values) {
  Instance moved;
  if (!schedule.empty())
    run_nodes(program, schedule, site_of(context, moved), Values<float>{glm::value_ptr(values.front()), 1});
}

glm::mat3 rotation(const glm::vec3 &angles) {
  const Columns<float> turn = turn_by(Vector3<float>(angles));
  return {turn.c[0], turn.c[1], turn.c[2]};
}

bool inverse_transpose(const float (&rows)[9], double (&result)[9]) {
  glm::dmat3 m;
  for (int i = 0; i < 9; ++i)
    m[i % 3][i / 3] = double(rows[i]);
  if (glm::determinant(m) == 0.0)
    return false;
  const glm::dmat3 back = glm::transpose(glm::inverse(m));
  for (int i = 0; i < 9; ++i)
    result[i] = back[i % 3][i / 3];
  return true;
}

void MaterialNodes::run(const ProgramView &program, ScheduleView schedule, const Surface &surface, const View &view) {
  if (schedule.empty())
    return;
  context_.surface = &surface;
  context_.wo = view.wo;
  context_.footprint = view.footprint;
  context_.path = view.path;
  lancer::run(program, schedule, context_, values_);
}

void MaterialNodes::run_painted(const ProgramView &program, ScheduleView schedule, const Hit &hit) {
  Surface surface;
  surface.instance = hit.instance;
  surface.primitive = hit.primitive;
  surface.bary = {hit.u, hit.v};
  run(program, schedule, surface, {});
}

size_t most_values(std::span<const MaterialView> materials) {
  size_t most = 0;
  for (const MaterialView &material : materials)
    most = std::max(most, material.program.value_count());
  return most;
}

} // namespace lancer
