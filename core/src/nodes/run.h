// The node machine: runs a program of nodes at a place, or at up to 16 places side by side.
//
// A formula of a node is one template over its number type: float for a single place, lanes of them for a block. Both give the
// same bits, whatever the number of lanes. Programs are those of scene/node.h: nodes refer to earlier ones, a schedule names
// those that are needed. To run one for a block:
//
//   NodeBlock block;               // block.h; fill in scene and the lanes, set their bits in used
//   NodeLanes values[nodes];       // room for all nodes of the program
//   node_kernel().run(program, schedule, block, values);
//   values[parameter.node].of[k][lane]  // k = 0 ... 3: x, y, z, alpha
//
// All lanes run the same program. They may lie on different instances; where all lie on one, its maps are read once. Lanes that
// are not used give no value that means anything.
#pragma once

#include "nodes/block.h"
#include "nodes/light_path.h"
#include "scene/node.h"
#include "scene/surface.h"
#include "simd/kernel_choice.h"

#include <span>

namespace lancer {

// Where nodes are evaluated. Everything is in the normalised world but what nodes see, which is in the user's units.
struct NodeContext : NodeScene {
  const Surface *surface = nullptr; // null: a direction of the world
  glm::vec3 wo{0, 0, 1};            // unit, towards the viewer; for the world minus the direction
  float footprint = 0.0f;           // radius of what a pixel covers here, in normalised units: the step of BUMP; 0: no bumps
  const glm::dvec3 *eye = nullptr;  // for the world: where the camera ray starts; null: any other ray
  LightPath<float> path;            // of the ray
};

// Computes the scheduled nodes into values, which has room for all nodes of the program.
void run(const Program &program, const Schedule &schedule, const NodeContext &context, std::span<glm::vec4> values);

// The same for a block.
struct NodeKernel {
  const char *name;
  void (*run)(const Program &program, const Schedule &schedule, const NodeBlock &block, NodeLanes *values);
};

// Each is the same source, node_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(NodeKernel, node_kernel)

} // namespace lancer
