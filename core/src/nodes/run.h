// The node machine: runs a program of nodes at one hit, or at up to 16 hits in lanes.
//
// The formula of a node is one template over its number type: float for a single hit, lanes of it for a block. Both give the
// same bits, for any number of lanes. Programs are those of scene/node.h: nodes refer to earlier ones, a schedule lists the
// nodes to evaluate. To run a program for a block:
//
//   NodeBlock block;               // block.h; set scene and the lanes, and their bits in used
//   NodeLanes values[count];       // Program::value_count()
//   node_kernel().run(program, schedule, block, values);
//   values[parameter.node].of[k][lane]  // k = 0 ... 3: x, y, z, alpha
//
// All lanes run the same program. They may be on different instances; if all are on one, its maps are read once. Results of
// unused lanes are undefined.
#pragma once

#include "nodes/block.h"
#include "nodes/light_path.h"
#include "scene/material.h"
#include "scene/node.h"
#include "scene/surface.h"
#include "simd/processor.h"

#include <span>
#include <vector>

namespace lancer {

// The input of a node evaluation. Everything is in the normalised world; nodes convert to the user's units.
struct NodeContext : NodeScene {
  const Surface *surface = nullptr; // null: a direction of the world
  glm::vec3 wo{0, 0, 1};            // unit, towards the viewer; for the world the negated direction
  float footprint = 0.0f;           // radius of the pixel's footprint, normalised units: the step of BUMP; 0: no bumps
  const glm::dvec3 *eye = nullptr;  // for the world: origin of the camera ray; null: any other ray
  bool displaces = false;           // a vertex is displaced
  LightPath<float> path;            // of the ray
};

// Computes the scheduled nodes. values has room for Program::value_count().
void run(const ProgramView &program, ScheduleView schedule, const NodeContext &context, std::span<glm::vec4> values);

// Runs a program for a block.
struct NodeKernel {
  const char *name;
  void (*run)(const ProgramView &program, ScheduleView schedule, const NodeBlock &block, NodeLanes *values);
};

// Declares the copies of node_kernel.cpp, each compiled with LANCER_ISA set to its name.
LANCER_DECLARE_KERNEL(NodeKernel, node_kernel)

// The nodes of materials, at one surface at a time.

// The view from which a material is evaluated.
struct View {
  glm::vec3 wo{0, 0, 1};   // unit, world, away from the surface
  float footprint = 0.0f;  // radius of a pixel's footprint there, normalised units
  LightPath<float> path{}; // of the ray that has hit the surface; for emission without a ray, the default
  // For nodes that look around: the address of random numbers, and whether the ray has passed no wide lobe.
  uint32_t pixel = 0, sample = 0, dimension = 0;
  bool sharp = false;
};

// One object per thread: it keeps the values of the last run.
class MaterialNodes {
public:
  // values: the most values of a program.
  MaterialNodes(const NodeScene &scene, size_t values) : values_(values) { static_cast<NodeScene &>(context_) = scene; }

  // Evaluates surfaces of this geometry instead of the scene's; it must outlive this object.
  void set_geometry(const GeometryView &geometry) { context_.geometry = &geometry; }
  const NodeScene &scene() const { return context_; }

  // Computes the scheduled nodes at a surface.
  void run(const ProgramView &program, ScheduleView schedule, const Surface &surface, const View &view);
  // Computes nodes that read only the triangle and the place within it.
  void run_painted(const ProgramView &program, ScheduleView schedule, const Hit &hit);
  // The results of the last run, by number of the node.
  std::span<glm::vec4> values() { return values_; }
  glm::vec3 value(const Parameter &parameter) const { return value_of(parameter, values_); }

private:
  NodeContext context_;
  std::vector<glm::vec4> values_;
};

// Returns the most values of a material's program.
size_t most_values(std::span<const MaterialView> materials);

} // namespace lancer
