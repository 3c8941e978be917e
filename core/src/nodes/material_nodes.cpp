#include "nodes/material_nodes.h"

#include <algorithm>

namespace lancer {

void MaterialNodes::run(const Program &program, const Schedule &schedule, const Surface &surface, const View &view) {
  if (schedule.empty())
    return;
  context_.surface = &surface;
  context_.wo = view.wo;
  context_.footprint = view.footprint;
  context_.path = view.path;
  lancer::run(program, schedule, context_, values_);
}

void MaterialNodes::run_painted(const Program &program, const Schedule &schedule, const Hit &hit) {
  Surface surface;
  surface.instance = hit.instance;
  surface.primitive = hit.primitive;
  surface.bary = {hit.u, hit.v};
  run(program, schedule, surface, {});
}

size_t most_nodes(std::span<const Material> materials) {
  size_t most = 0;
  for (const Material &material : materials)
    most = std::max(most, material.program.nodes.size());
  return most;
}

} // namespace lancer
