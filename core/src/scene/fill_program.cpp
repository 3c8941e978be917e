// Checks and copies nodes, so that evaluation needs no checks.
#include "scene/description.h"
#include "scene/fill.h"
#include "scene/messages.h"
#include "scene/names.h"
#include "scene/surface.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace lancer {

namespace {

// Data that a kind of node reads: the number of inputs, the number of options, whether the matrix is used.
struct Shape {
  int inputs;
  uint32_t options;
  bool matrix;
};

Shape shape_of(const lancer_node &node) {
  switch (node.kind) {
  case LANCER_NODE_COORDINATE:
    return {0, LANCER_COORDINATE_COUNT, node.option == LANCER_COORDINATE_OBJECT && (node.flags & 1)};
  case LANCER_NODE_ATTRIBUTE:
    return {0, 0, false};
  case LANCER_NODE_IMAGE:
    return {node.option == LANCER_PROJECT_BOX ? 2 : 1, 4, false};
  case LANCER_NODE_ENVIRONMENT:
    return {1, 3, false};
  case LANCER_NODE_ALPHA:
    return {1, 0, false};
  case LANCER_NODE_MAPPING:
    return {4, 4, false};
  case LANCER_NODE_TRANSFORM:
    return {1, 3, true};
  case LANCER_NODE_MATH:
    return {3, LANCER_MATH_COUNT, false};
  case LANCER_NODE_VECTOR_MATH:
    return {4, LANCER_VECTOR_COUNT, false};
  case LANCER_NODE_MIX:
    return {3, LANCER_MIX_COUNT, false};
  case LANCER_NODE_SEPARATE:
    return {1, 3, false};
  case LANCER_NODE_COMBINE:
    return {3, 0, false};
  case LANCER_NODE_GREY:
    return {1, 0, true};
  case LANCER_NODE_FRESNEL:
    return {2, 0, false};
  case LANCER_NODE_LAYER_WEIGHT:
    return {2, 2, false};
  case LANCER_NODE_NORMAL_MAP:
    return {3, 5, false};
  case LANCER_NODE_BUMP:
    return {5, 0, false};
  case LANCER_NODE_TANGENT:
    return {1, 4, false};
  case LANCER_NODE_CLAMP:
    return {3, 0, false};
  case LANCER_NODE_DISPLACEMENT:
    return {4, 2, false};
  case LANCER_NODE_COLOR_MODEL:
    return {1, LANCER_COLOR_COUNT, false};
  case LANCER_NODE_NOISE:
    return {4, LANCER_NOISE_COUNT, false};
  case LANCER_NODE_VORONOI:
    return {4, LANCER_VORONOI_COUNT, false};
  case LANCER_NODE_GRADIENT:
    return {1, LANCER_GRADIENT_COUNT, false};
  case LANCER_NODE_CURVES:
    return {2, 2, true};
  case LANCER_NODE_WAVE:
    return {3, LANCER_PROFILE_COUNT, false};
  case LANCER_NODE_MAGIC:
    return {2, 11, false};
  case LANCER_NODE_CHECKER:
    return {2, 0, false};
  case LANCER_NODE_BRICK:
    return {5, 0, false};
  case LANCER_NODE_GABOR:
    return {3, 2, false};
  case LANCER_NODE_RADIAL_TILING:
    return {2, 2, false};
  case LANCER_NODE_WIREFRAME:
    return {1, 0, false};
  case LANCER_NODE_IES:
    return {2, 0, false};
  case LANCER_NODE_OCCLUSION:
    return {2, LANCER_MOST_NODE_RAYS + 1, false};
  case LANCER_NODE_BEVEL:
    return {3, LANCER_MOST_NODE_RAYS + 1, false};
  case LANCER_NODE_RAYCAST:
    return {3, 4, false};
  case LANCER_NODE_VECTOR_TRANSFORM:
  case LANCER_NODE_VOXELS:
    return {1, 3, false};
  case LANCER_NODE_SKY:
    return {1, LANCER_SKY_COUNT, true};
  case LANCER_NODE_OBJECT_INFO:
    return {0, LANCER_OBJECT_COUNT, false};
  case LANCER_NODE_LIGHT_PATH:
    return {0, LANCER_PATH_COUNT, false};
  default:
    return {2, 0, false};
  }
}

// Returns the valid flags of a kind.
uint32_t flags_of(uint32_t kind) {
  switch (kind) {
  case LANCER_NODE_COORDINATE:
  case LANCER_NODE_MATH:
  case LANCER_NODE_NORMAL_MAP:
  case LANCER_NODE_MAGIC:
  case LANCER_NODE_RADIAL_TILING:
  case LANCER_NODE_WIREFRAME:
    return 1;
  case LANCER_NODE_OCCLUSION:
    return 1 | 2;
  case LANCER_NODE_ATTRIBUTE:
    return LANCER_ATTRIBUTE_OPAQUE | LANCER_ATTRIBUTE_FIRST | LANCER_ATTRIBUTE_STILL;
  case LANCER_NODE_TANGENT:
  case LANCER_NODE_MIX:
    return 1 | 2;
  case LANCER_NODE_BUMP:
  case LANCER_NODE_RAYCAST:
    return 1 | 2 | 4;
  case LANCER_NODE_IMAGE:
    return 0xff | 256 | 512;
  case LANCER_NODE_ENVIRONMENT:
    return 0xff | 256;
  case LANCER_NODE_NOISE:
    return 3 | LANCER_NOISE_NORMALIZED | LANCER_NOISE_REPEATS | LANCER_NOISE_COUNTED | LANCER_NOISE_COLOR;
  case LANCER_NODE_VORONOI:
    return 3 | 3 << 2 | LANCER_VORONOI_NORMALIZED | LANCER_VORONOI_COLOR | LANCER_VORONOI_POSITION | LANCER_VORONOI_INTEGERS |
           LANCER_VORONOI_BOUNDED;
  case LANCER_NODE_CURVES:
    return 1 | 2;
  case LANCER_NODE_WAVE:
    return 7 | LANCER_NOISE_REPEATS;
  case LANCER_NODE_WHITE_NOISE:
    return 3 | LANCER_NOISE_COLOR;
  case LANCER_NODE_VECTOR_TRANSFORM:
    return 3 | 3 << 2;
  default:
    return 0;
  }
}

class ProgramReader {
public:
  ProgramReader(Images images, const std::string &owner, Program &program)
      : images_(images), owner_(owner), program_(program) {}

  Node read(const lancer_node &given, uint32_t at) {
    where_ = owner_ + ": node " + std::to_string(at) + ": ";
    if (given.kind >= LANCER_NODE_COUNT)
      bad_argument(where_ + "kind " + std::to_string(given.kind) + " is unknown");
    const Shape shape = shape_of(given);
    if (shape.options && given.option >= shape.options)
      bad_argument(where_ + "option " + std::to_string(given.option) + " >= " + std::to_string(shape.options) + " options");
    const uint32_t flags = given.flags & ~LANCER_NODE_STEADY;
    check_flags(where_, flags, flags_of(given.kind));
    if (given.kind == LANCER_NODE_VECTOR_TRANSFORM && ((flags & 3) == 3 || flags >> 2 == 3))
      bad_argument(where_ + "flags " + std::to_string(flags) + " name a space that does not exist");
    Node node;
    node.kind = given.kind;
    node.option = given.option;
    node.flags = flags;
    node.steady = flags != given.flags;
    for (int i = 0; i < shape.inputs; ++i)
      node.inputs[i] = read_input(given.inputs[i], i, at);
    if (shape.matrix)
      read_matrix(given, node);
    if (given.kind == LANCER_NODE_IMAGE || given.kind == LANCER_NODE_ENVIRONMENT)
      read_pictures(given, node);
    if (given.kind == LANCER_NODE_CURVES)
      read_table(given, node);
    if (given.kind == LANCER_NODE_IES)
      read_angles(given, node);
    if (given.kind == LANCER_NODE_SKY)
      read_sky(given, node);
    if (given.kind == LANCER_NODE_VOXELS)
      read_voxels(given, node);
    if (given.kind == LANCER_NODE_BUMP) {
      if (given.first > at)
        bad_argument(where_ + "first " + std::to_string(given.first) + " is a later node");
      node.first = given.first;
    }
    read_names(given, node);
    return node;
  }

private:
  Parameter read_input(const lancer_parameter &given, int i, uint32_t at) const {
    const std::string input = "input " + std::to_string(i) + " ";
    Parameter result;
    result.node = given.node;
    if (given.node < -1 || given.node >= int64_t(at))
      bad_argument(where_ + input + "refers to node " + std::to_string(given.node) + ", which does not precede it");
    if (given.node >= 0)
      return result;
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(given.value[k]))
        bad_argument(where_ + input + "is " + to_text(given.value[k]));
      result.value[k] = given.value[k];
    }
    return result;
  }

  void read_matrix(const lancer_node &given, Node &node) const {
    for (int i = 0; i < 12; ++i) {
      if (!std::isfinite(given.matrix[i]))
        bad_argument(where_ + "matrix contains " + to_text(given.matrix[i]));
      node.matrix[i] = given.matrix[i];
    }
  }

  // Gives the node images of the program's own.
  void refer_to(uint32_t first, uint32_t count, Node &node) {
    const auto [known, fresh] = known_.try_emplace({first, count}, uint32_t(program_.images.size()));
    for (uint32_t i = first; fresh && i < first + count; ++i) {
      program_.images.push_back(*images_[i]);
      program_.held.push_back(images_[i].object);
    }
    node.image = known->second;
    node.image_count = count;
  }

  void read_pictures(const lancer_node &given, Node &node) {
    const size_t images = images_.size();
    if (uint64_t(given.image) + given.image_count > images)
      bad_argument(where_ + "images " + std::to_string(given.image) + " + " + std::to_string(given.image_count) + " > " +
                   std::to_string(images) + " images");
    if ((given.flags & 0xf) > LANCER_EXTEND_MIRROR)
      bad_argument(where_ + "extension " + std::to_string(given.flags & 0xf) + " is not one of 0 ... 3");
    if ((given.flags >> 4 & 0xf) > LANCER_INTERPOLATE_CUBIC)
      bad_argument(where_ + "interpolation " + std::to_string(given.flags >> 4 & 0xf) + " is not one of 0, 1, 2");
    if (given.kind == LANCER_NODE_ENVIRONMENT && given.option == LANCER_ENVIRONMENT_CUBE && given.image_count != 6)
      bad_argument(where_ + std::to_string(given.image_count) + " images for the 6 sides of a cube");
    refer_to(given.image, given.image_count, node);
    for (uint32_t i = 0; i < given.image_count; ++i)
      node.mipmapped |= images_[given.image + i]->levels > 1;
  }

  const Image &table_of(const lancer_node &given, Node &node) {
    if (given.image >= images_.size())
      bad_argument(where_ + "image " + std::to_string(given.image) + " >= " + std::to_string(images_.size()) + " images");
    const Image &table = *images_[given.image];
    if (table.in_blocks)
      bad_argument(where_ + label("image", table.name.c_str(), given.image) + " is a table, but its texels are blocks");
    refer_to(given.image, 1, node);
    return table;
  }

  void read_table(const lancer_node &given, Node &node) {
    const Image &table = table_of(given, node);
    if (table.kind != TexelKind::Float || table.height != 1 || table.width < 2)
      bad_argument(where_ + "image " + std::to_string(given.image) + " is not a row of at least two floating-point texels");
  }

  void read_angles(const lancer_node &given, Node &node) {
    const Image &table = table_of(given, node);
    const std::string image = where_ + "image " + std::to_string(given.image);
    if (table.kind != TexelKind::Float || table.channels != 1 || table.width < 5 || table.height < 5)
      bad_argument(image + " is not a table of at least 5 x 5 floating-point numbers");
    const auto *texels = reinterpret_cast<const float *>(table.texels);
    const auto check = [&](uint32_t count, size_t stride) {
      for (uint32_t i = 2; i + 1 < count; ++i)
        if (!std::isfinite(texels[i * stride]) || (i > 2 && !(texels[i * stride] >= texels[(i - 1) * stride])))
          bad_argument(image + ": angle " + to_text(texels[i * stride]) + " is not above the one before");
    };
    check(table.width, 1);
    check(table.height, table.width);
  }

  void read_sky(const lancer_node &given, Node &node) {
    const Image &table = table_of(given, node);
    const bool fits = given.option > LANCER_SKY_HOSEK_WILKIE || (table.height == 1 && table.width == kSkyTexels);
    if (table.kind != TexelKind::Float || table.channels != 3 || !fits)
      bad_argument(where_ + "image " + std::to_string(given.image) + " is not a table of the sky");
  }

  void read_voxels(const lancer_node &given, Node &node) {
    const Image &cube = table_of(given, node);
    if (cube.kind != TexelKind::Float || cube.channels != 4 || cube.height != uint64_t(cube.width) * cube.width)
      bad_argument(where_ + "image " + std::to_string(given.image) + " is not a cube of four floating-point numbers each");
  }

  // Converts names to numbers, including names that the kind implies.
  void read_names(const lancer_node &given, Node &node) {
    const std::string name = given.name ? given.name : "";
    const bool generated = (node.kind == LANCER_NODE_COORDINATE && node.option == LANCER_COORDINATE_GENERATED) ||
                           (node.kind == LANCER_NODE_TANGENT && node.option < 3);
    const bool undisplaced = node.kind == LANCER_NODE_BUMP && (node.flags & 2);
    node.name = undisplaced ? kUndisplaced : attribute_name(generated ? "generated" : name);
    if (node.kind == LANCER_NODE_NORMAL_MAP || node.kind == LANCER_NODE_TANGENT)
      node.tangent = attribute_name("tangent:" + name);
  }

  Images images_;
  const std::string &owner_;
  Program &program_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> known_; // numbers in the program by first and count
  std::string where_;
};

// Returns the nodes of a bump that its height depends on.
Schedule height_schedule(const Program &program, uint32_t bump) {
  const Node &owner = program.nodes[bump];
  std::vector<bool> needed(bump);
  const auto mark = [&](const Parameter &input) {
    if (input.varies() && input.node >= int32_t(owner.first))
      needed[size_t(input.node)] = true;
  };
  mark(owner.inputs[2]);
  for (size_t i = bump; i-- > owner.first;) {
    if (!needed[i])
      continue;
    const Node &node = program.nodes[i];
    for (int k = 0; k < 5; ++k)
      if (is_read_in_height(node, k))
        mark(node.inputs[k]);
  }
  Schedule schedule;
  for (size_t i = owner.first; i < bump; ++i)
    if (needed[i])
      schedule.push_back(uint16_t(i));
  return schedule;
}

} // namespace

Program read_program(Images images, const std::string &owner, const lancer_node *nodes, uint32_t count) {
  if (count > LANCER_MOST_NODES)
    bad_argument(owner + ": " + std::to_string(count) + " nodes > " + std::to_string(LANCER_MOST_NODES));
  if (count && !nodes)
    bad_argument(owner + ": nodes is NULL for " + std::to_string(count) + " nodes");
  Program program;
  ProgramReader reader(images, owner, program);
  program.nodes.reserve(count);
  for (uint32_t i = 0; i < count; ++i)
    program.nodes.push_back(reader.read(nodes[i], i));
  for (uint32_t i = 0; i < count; ++i) {
    // Pixels have a size for camera rays alone.
    const Node &node = program.nodes[i];
    program.asks_light_path |= node.kind == LANCER_NODE_LIGHT_PATH || (node.kind == LANCER_NODE_WIREFRAME && node.flags & 1);
    program.looks_around |= looks_around(node.kind);
    if (node.kind != LANCER_NODE_BUMP)
      continue;
    const Schedule heights = height_schedule(program, i);
    program.nodes[i].heights = uint32_t(program.height_nodes.size());
    program.nodes[i].height_count = uint32_t(heights.size());
    program.height_nodes.insert(program.height_nodes.end(), heights.begin(), heights.end());
  }
  program.number_changes();
  return program;
}

void check_reference(const std::string &owner, const char *what, const lancer_parameter &parameter, const Program &program) {
  if (parameter.node < -1 || parameter.node >= int64_t(program.nodes.size()))
    bad_argument(owner + ": " + what + " refers to node " + std::to_string(parameter.node) + ", but there are " +
                 std::to_string(program.nodes.size()) + " nodes");
}

std::vector<Output> read_outputs(const std::string &owner, const lancer_output *outputs, uint32_t count,
                                 const Program &program) {
  if (count > LANCER_MOST_NODES)
    bad_argument(owner + ": " + std::to_string(count) + " outputs > " + std::to_string(LANCER_MOST_NODES));
  if (count && !outputs)
    bad_argument(owner + ": outputs is NULL for " + std::to_string(count) + " outputs");
  std::vector<Output> all(count);
  for (uint32_t i = 0; i < count; ++i) {
    const lancer_output &given = outputs[i];
    check_reference(owner, "an output", given.value, program);
    if (given.is_color > 1)
      bad_argument(owner + ": output " + std::to_string(i) + " has is_color " + std::to_string(given.is_color) +
                   ", which is not 0 or 1");
    all[i] = {given.number,
              given.is_color != 0,
              {{given.value.value[0], given.value.value[1], given.value.value[2]}, given.value.node}};
  }
  return all;
}

Schedule schedule_of(std::span<const Output> outputs, const Program &program) {
  std::vector<Parameter> values;
  for (const Output &output : outputs)
    values.push_back(output.value);
  return program.schedule(values);
}

} // namespace lancer
