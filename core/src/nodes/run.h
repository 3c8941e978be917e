// The node machine: runs a program of nodes at one hit, or at up to 16 hits in lanes.
//
// The formula of a node is one template over its number type: float for a single hit, lanes of it for a block. Both give the
// same bits, for any number of lanes. Programs are those of scene/node.h: nodes refer to earlier ones, a schedule lists the
// nodes to evaluate. To run a program for a block:
//
//   NodeBlock block;               // block.h; set scene and the lanes, and their bits in used
//   NodeLanes values[nodes];       // room for all nodes of the program
//   node_kernel().run(program, schedule, block, values);
//   values[parameter.node].of[k][lane]  // k = 0 ... 3: x, y, z, alpha
//
// All lanes run the same program. They may be on different instances; if all are on one, its maps are read once. Results of
// unused lanes are undefined.
#pragma once

#include "nodes/block.h"
#include "nodes/light_path.h"
#include "scene/node.h"
#include "scene/surface.h"
#include "simd/kernel_choice.h"

#include <span>

namespace lancer {

// The input of a node evaluation. Everything is in the normalised world; nodes convert to the user's units.
struct NodeContext : NodeScene {
  const Surface *surface = nullptr; // null: a direction of the world
  glm::vec3 wo{0, 0, 1};            // unit, towards the viewer; for the world the negated direction
  float footprint = 0.0f;           // radius of the pixel's footprint, normalised units: the step of BUMP; 0: no bumps
  const glm::dvec3 *eye = nullptr;  // for the world: origin of the camera ray; null: any other ray
  LightPath<float> path;            // of the ray
};

// Computes the scheduled nodes. values has room for all nodes of the program.
void run(const Program &program, const Schedule &schedule, const NodeContext &context, std::span<glm::vec4> values);

// Runs a program for a block.
struct NodeKernel {
  const char *name;
  void (*run)(const Program &program, const Schedule &schedule, const NodeBlock &block, NodeLanes *values);
};

// Each is node_kernel.cpp compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(NodeKernel, node_kernel)

} // namespace lancer
