// Nodes: what a material, or the world, computes at a place before its lobes are known.
#pragma once

#include "lancer.h"
#include "scene/image.h"
#include "scene/surface.h"

#include <span>
#include <vector>

namespace lancer {

// One value: a constant, or the result of a node.
struct Parameter {
  glm::vec3 value{0.0f};
  int32_t node = -1;

  bool varies() const { return node >= 0; }
};

struct Node {
  uint32_t kind = 0, option = 0, flags = 0;
  uint32_t image = 0, image_count = 0, first = 0;
  uint32_t name = 0;    // number of the name among Description::attribute_names; 0 is "", kUndisplaced is none of them
  uint32_t tangent = 0; // likewise, of the tangents that belong to the UV map of that name
  uint32_t heights = 0; // BUMP: number of its schedule among Program::heights
  Parameter inputs[5];
  float matrix[12] = {};
};

// Within the height of a bump another bump only hands on its normal.
inline bool is_read_in_height(const Node &node, int input) { return node.kind != LANCER_NODE_BUMP || input == 3; }

// Numbers of nodes in the order in which to compute them.
using Schedule = std::vector<uint16_t>;

struct Program {
  std::vector<Node> nodes;
  std::vector<Schedule> heights; // of each BUMP: those of its nodes [first, this) that its height needs
  bool asks_light_path = false;  // a node of it does

  // The nodes that the parameters need, directly or not, in order; a BUMP's own height nodes are left to it.
  Schedule schedule(std::span<const Parameter> parameters) const;
  // The node that a value comes from; null where it is constant.
  const Node *source(const Parameter &value) const { return value.varies() ? &nodes[size_t(value.node)] : nullptr; }
};

inline glm::vec3 value_of(const Parameter &parameter, std::span<const glm::vec4> values) {
  return parameter.node < 0 ? parameter.value : glm::vec3(values[size_t(parameter.node)]);
}

// Whether a node asks nothing of a surface, a ray or a picture: with constants for inputs it has a value by itself.
bool asks_no_place(uint32_t kind);

} // namespace lancer
