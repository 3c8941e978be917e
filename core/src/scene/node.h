// Nodes: computations of a material or the world at a hit, before its lobes are known.
#pragma once

#include "scene/enums.h"
#include "scene/image.h"
#include "scene/surface.h"

#include <memory>
#include <span>
#include <vector>

namespace lancer {

// One value: a constant, or the result of a node.
struct Parameter {
  glm::vec3 value{0.0f};
  int32_t node = -1;

  bool varies() const { return node >= 0; }
};

// A value that goes into a pass, see lancer_output.
struct Output {
  uint32_t number = 0;
  bool is_color = false;
  Parameter value;
};

// SKY: texels of the table of PREETHAM and HOSEK_WILKIE: the sun, the radiance and nine coefficients.
inline constexpr uint32_t kSkyTexels = 11;

struct Node {
  uint32_t kind = 0, option = 0, flags = 0;
  uint32_t image = 0, image_count = 0; // in Program::images
  uint32_t first = 0;
  uint32_t name = 0;                      // of scene/names.h; kUndisplaced is outside its list
  uint32_t tangent = 0;                   // the name of the tangents of this UV map
  uint32_t heights = 0, height_count = 0; // BUMP: its schedule in Program::height_nodes
  int32_t changes = -1;   // of its value over a pixel: the number of the first of two values that hold them; -1: not needed
  bool steady = false;    // its value is taken as constant over a pixel
  bool mipmapped = false; // IMAGE, ENVIRONMENT: some of its images have levels
  Parameter inputs[5];
  float matrix[12] = {};
};

// Returns whether a height evaluation reads an input: a bump inside the height of another bump only passes on its normal.
inline bool is_read_in_height(const Node &node, int input) { return node.kind != NodeKind::Bump || input == 3; }

// Numbers of nodes in order of evaluation.
using Schedule = std::vector<uint16_t>;
using ScheduleView = std::span<const uint16_t>;

struct ProgramView {
  std::span<const Node> nodes;
  std::span<const uint16_t> height_nodes; // of each BUMP: the nodes among [first, this) that its height depends on
  std::span<const ImageView> images;
  bool asks_light_path = false; // whether a node reads the light path
  bool looks_around = false;    // whether a node sends rays
  bool mipmapped = false;       // whether a node reads levels of images
  uint32_t changing = 0;        // number of nodes whose changes are needed

  // Returns the number of values of a run: those of all nodes, and two changes of each that needs them.
  size_t value_count() const { return nodes.size() + 2 * changing; }
  // Returns the node of a value; null if it is constant.
  const Node *source(const Parameter &value) const { return value.varies() ? &nodes[size_t(value.node)] : nullptr; }
  // Returns the nodes that the parameters depend on, directly or indirectly, in order of evaluation, without the height nodes
  // of a BUMP.
  Schedule schedule(std::span<const Parameter> parameters) const;
  ScheduleView heights_of(const Node &bump) const { return height_nodes.subspan(bump.heights, bump.height_count); }
};

// The memory of a program.
struct Program {
  std::vector<Node> nodes;
  std::vector<uint16_t> height_nodes;
  std::vector<ImageView> images;
  std::vector<std::shared_ptr<const Image>> held; // those of images
  bool asks_light_path = false, looks_around = false, mipmapped = false;
  uint32_t changing = 0;

  // Valid until the program changes.
  operator ProgramView() const { return {nodes, height_nodes, images, asks_light_path, looks_around, mipmapped, changing}; }
  size_t value_count() const { return ProgramView(*this).value_count(); }
  const Node *source(const Parameter &value) const { return ProgramView(*this).source(value); }
  // Numbers the changes that images with levels need; to be called when all nodes are there.
  void number_changes();
  Schedule schedule(std::span<const Parameter> parameters) const { return ProgramView(*this).schedule(parameters); }
};

inline glm::vec3 value_of(const Parameter &parameter, std::span<const glm::vec4> values) {
  return parameter.node < 0 ? parameter.value : glm::vec3(values[size_t(parameter.node)]);
}

// Returns whether a kind of node depends on its inputs alone, not on a surface, a ray or an image.
bool asks_no_place(uint32_t kind);
// Returns whether a kind of node sends rays.
bool looks_around(uint32_t kind);

} // namespace lancer
