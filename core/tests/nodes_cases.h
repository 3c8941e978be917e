// Nodes of every kind, option and flag, with various inputs, at various hits.
#pragma once

#include "nodes_lab.h"
#include "scene/names.h"
#include "scene/surface.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace lancer_test {

using Random = std::mt19937;

inline float uniform_number(Random &random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

// Numbers of all sizes and signs, none of them frequent.
inline float any_number(Random &random) {
  const float special[] = {0.0f,  -0.0f,  1.0f,   -1.0f,  0.5f,     -0.5f,     2.0f,
                           1e30f, -1e30f, 1e-30f, 3.7e5f, INFINITY, -INFINITY, NAN};
  const uint32_t sort = random() % 16;
  return sort == 0   ? special[random() % std::size(special)]
         : sort < 10 ? uniform_number(random, -2.0f, 2.0f)
         : sort < 14 ? uniform_number(random, 0.0f, 1.0f)
                     : uniform_number(random, -100.0f, 100.0f);
}

inline glm::vec3 any_direction(Random &random) {
  glm::vec3 d(uniform_number(random, -1.0f, 1.0f), uniform_number(random, -1.0f, 1.0f), uniform_number(random, -1.0f, 1.0f));
  if (random() % 8 == 0)
    d[int(random() % 3)] = 0.0f;
  return glm::dot(d, d) > 0.0f ? glm::normalize(d) : glm::vec3(0, 0, 1);
}

inline constexpr uint32_t kFreeImages = 40, kTiles = kFreeImages, kSides = kTiles + 3, kTables = kSides + 6,
                          kAngles = kTables + 3, kSkies = kAngles + 1, kVoxels = kSkies + 2;

// A world of five instances (two meshes, three exact surfaces) and images of all forms: kFreeImages of any form, then 3 tiles,
// then the 6 sides of a cube, then tables of curves of 1, 3 and 4 channels, the light of a luminaire, two tables of the sky,
// and a cube of voxels.
class NodeWorld {
public:
  Description description;
  Normalisation normalisation{{0.5, -1.0, 2.0}, 0.25};
  Camera camera;

  explicit NodeWorld(Random &random) {
    add_meshes(random);
    for (int i = 0; i < 5; ++i) {
      Instance instance;
      Affine map;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
          map.linear[c][r] = double(uniform_number(random, -1.0f, 1.0f)) + (c == r ? 1.5 : 0.0);
      map.translation = {double(i), -double(i), 0.25};
      instance.place(map);
      const ShapeKind kinds[] = {ShapeKind::Mesh, ShapeKind::Mesh, ShapeKind::Sphere, ShapeKind::Plane, ShapeKind::Cone};
      instance.kind = kinds[i];
      instance.mesh = uint32_t(i & 1);
      instance.shading = i == 1 ? Shading::Flat : Shading::AsMesh;
      instance.number = uint32_t(4 - i);
      instance.object_index = uint32_t(3 * i);
      description.instances.push_back(instance);
      if (i < 4)
        description.object_infos.push_back({glm::vec4(any_direction(random), 0.5f), uniform_number(random, 0.0f, 1.0f)});
    }
    // Values of fewer objects than there are.
    description.object_attributes.push_back({attribute_name("paint"), {{0.1f, 0.2f, 0.3f, 0.4f}, {-1.0f, 2.0f, 0.5f, 0.0f}}});
    for (uint32_t i = 0; i < kSides + 6; ++i)
      add_any_image(random, i >= kTiles && i < kSides ? (i == kTiles ? 1001 : i == kTiles + 1 ? 1002 : 1011) : 0);
    for (const uint32_t channels : {1u, 3u, 4u}) {
      std::vector<float> values(size_t(7) * channels);
      for (float &x : values)
        x = uniform_number(random, -1.0f, 2.0f);
      add_image(description, image_of(values, 7, 1, channels));
    }
    add_luminaire(random);
    for (const uint32_t rows : {1u, 6u}) {
      std::vector<float> values(size_t(kSkyTexels) * rows * 3);
      for (float &x : values)
        x = uniform_number(random, -1.0f, 1.0f);
      add_image(description, image_of(values, kSkyTexels, rows, 3));
    }
    std::vector<float> voxels(3 * 3 * 3 * 4);
    for (float &x : voxels)
      x = uniform_number(random, 0.0f, 1.0f);
    add_image(description, image_of(voxels, 3, 9, 4));
    camera.to_world = description.instances[2].to_world;
  }

  Surface surface(Random &random, uint32_t instance) const {
    Surface s;
    const Instance &placed = description.instances[instance];
    s.instance = instance;
    s.primitive = placed.kind == ShapeKind::Mesh ? random() % 2 : 0;
    const double u = double(uniform_number(random, 0.0f, 1.0f)), v = double(uniform_number(random, 0.0f, 1.0f)) * (1.0 - u);
    s.bary = placed.kind == ShapeKind::Mesh ? glm::dvec2(u, v) : glm::dvec2(0.0);
    s.p = placed.to_world.point(glm::dvec3(any_direction(random)));
    s.ng = any_direction(random);
    s.ns = random() % 3 ? glm::normalize(s.ng + 0.3f * any_direction(random)) : s.ng;
    return s;
  }

private:
  void add_meshes(Random &random) {
    std::vector<float> positions(12), uvs(12), paint(24), generated(12), tangents(24), normals(12), colors(18), face(4);
    const uint32_t corners[] = {0, 1, 2, 2, 1, 3};
    for (std::vector<float> *numbers : {&positions, &uvs, &paint, &generated, &tangents, &normals, &colors, &face})
      for (float &x : *numbers)
        x = uniform_number(random, -1.0f, 1.0f);
    const lancer_attribute attributes[] = {{"paint", paint.data(), LANCER_DOMAIN_CORNER, 4},
                                           {"generated", generated.data(), LANCER_DOMAIN_VERTEX, 3},
                                           {"tangent:map", tangents.data(), LANCER_DOMAIN_CORNER, 4},
                                           {"map", uvs.data(), LANCER_DOMAIN_CORNER, 2},
                                           {"face", face.data(), LANCER_DOMAIN_FACE, 2},
                                           {"grey", paint.data(), LANCER_DOMAIN_CORNER, 1}};
    lancer_mesh mesh = {};
    mesh.name = "all";
    mesh.positions = positions.data();
    mesh.triangles = corners;
    mesh.vertex_count = 4;
    mesh.triangle_count = 2;
    mesh.uvs = uvs.data();
    mesh.colors = colors.data();
    mesh.normals = normals.data();
    mesh.normal_domain = LANCER_NORMALS_VERTEX;
    mesh.attributes = attributes;
    mesh.attribute_count = uint32_t(std::size(attributes));
    Messages messages;
    Mesh all = read_mesh(mesh, 0, messages);
    all.add_attribute(kUndisplaced, Domain::Vertex, 3);
    all.attribute_values.insert(all.attribute_values.end(), generated.begin(), generated.end());
    description.meshes.emplace_back(std::move(all));
    // Without optional data, except rare attributes.
    mesh.colors = nullptr;
    mesh.normals = nullptr;
    mesh.normal_domain = LANCER_NORMALS_NONE;
    mesh.attribute_count = 1;
    add_mesh(description, mesh);
  }

  // Angles from 0 to pi and around, with intensities between and beside them.
  void add_luminaire(Random &random) {
    const uint32_t width = 8, height = 7;
    std::vector<float> texels(size_t(width) * height);
    for (float &x : texels)
      x = uniform_number(random, 0.0f, 1.0f);
    for (uint32_t i = 2; i + 1 < width; ++i)
      texels[i] = 3.14159265f * float(i - 2) / float(width - 4);
    for (uint32_t i = 2; i + 1 < height; ++i)
      texels[size_t(i) * width] = 6.2831853f * float(i - 2) / float(height - 4);
    add_image(description, image_of(texels, width, height, 1));
  }

  void add_any_image(Random &random, uint32_t tile) {
    const uint32_t width = 1 + random() % 9, height = 1 + random() % 9, all_channels[] = {1, 3, 4},
                   channels = all_channels[random() % 3], kind = random() % 3;
    std::vector<uint8_t> bytes(size_t(width) * height * channels);
    std::vector<uint16_t> words(bytes.size());
    std::vector<float> floats(bytes.size());
    for (size_t i = 0; i < bytes.size(); ++i) {
      words[i] = uint16_t(random() % 3 ? random() : 65535);
      bytes[i] = uint8_t(words[i]);
      floats[i] = uniform_number(random, -0.25f, 1.5f);
    }
    lancer_image image = kind == 0   ? image_of(bytes, width, height, channels)
                         : kind == 1 ? image_of(words, width, height, channels)
                                     : image_of(floats, width, height, channels);
    image.transfer = random() % 2;
    image.alpha = random() % 4;
    image.tile = tile;
    if (random() % 3 == 0)
      for (float &x : image.matrix)
        x = uniform_number(random, -0.5f, 1.0f);
    add_image(description, image);
  }
};

// One node, after five whose values are its inputs, and for a bump its height's nodes.
struct NodeCase {
  std::string name;
  std::vector<lancer_node> nodes;
};

inline NodeCase make_case(Random &random, uint32_t kind, uint32_t option, uint32_t flags, const std::string &what = "") {
  NodeCase made{"kind " + std::to_string(kind) + " option " + std::to_string(option) + " flags " + std::to_string(flags) + what,
                std::vector<lancer_node>(5, node(LANCER_NODE_COMBINE))};
  lancer_node last = flagged(node(kind, option), flags);
  for (int i = 0; i < 5; ++i)
    last.inputs[i] = random() % 4 ? result_of(i) : constant(uniform_number(random, -1.0f, 2.0f), 0.5f, -0.25f);
  for (float &x : last.matrix)
    x = uniform_number(random, -1.0f, 1.0f);
  const char *names[] = {"", "map", "paint", "face", "grey", "none"};
  last.name = names[random() % 6];
  if (kind == LANCER_NODE_OBJECT_INFO)
    last.name = "paint";
  const bool environment = kind == LANCER_NODE_ENVIRONMENT;
  if (kind == LANCER_NODE_IMAGE || environment) {
    const bool cube = environment && option == LANCER_ENVIRONMENT_CUBE, tiles = !environment && random() % 4 == 0;
    last.image = cube ? kSides : tiles ? kTiles : random() % kFreeImages;
    last.image_count = cube ? 6 : tiles ? 3 : random() % 16 ? 1 : 0;
  }
  if (kind == LANCER_NODE_IES) {
    last.image = kAngles;
    last.image_count = 1;
  }
  if (kind == LANCER_NODE_CURVES) {
    last.image = kTables + (option == 0 ? random() % 2 : random() % 3);
    last.matrix[0] = -0.5f;
    last.matrix[1] = 1.25f;
  }
  if (kind == LANCER_NODE_SKY) {
    last.image = kSkies + (option > LANCER_SKY_HOSEK_WILKIE ? 1 : 0);
    for (int k = 0; k < 3; ++k)
      last.matrix[6 + k] = any_direction(random)[k];
    last.matrix[9] = random() % 4 ? uniform_number(random, 0.0f, 3.0f) : 0.0f;
  }
  if (kind == LANCER_NODE_VOXELS)
    last.image = kVoxels;
  if (kind == LANCER_NODE_BUMP) {
    const uint32_t places[] = {LANCER_COORDINATE_UV,       LANCER_COORDINATE_GENERATED, LANCER_COORDINATE_NORMAL,
                               LANCER_COORDINATE_POSITION, LANCER_COORDINATE_OBJECT,    LANCER_COORDINATE_PARAMETRIC};
    made.nodes.push_back(node(LANCER_NODE_COORDINATE, places[random() % 6]));
    lancer_node picture = node(LANCER_NODE_IMAGE, 0, {result_of(5)});
    picture.image = random() % kFreeImages;
    picture.image_count = 1;
    made.nodes.push_back(picture);
    made.nodes.push_back(node(LANCER_NODE_MATH, LANCER_MATH_MULTIPLY_ADD, {result_of(6), constant(0.3f), result_of(0)}));
    // Sometimes more than a bump keeps on the stack.
    for (int more = random() % 4 == 0 ? 40 : 0; more > 0; --more)
      made.nodes.push_back(
          node(LANCER_NODE_MATH, LANCER_MATH_ADD, {result_of(int32_t(made.nodes.size()) - 1), constant(0.01f)}));
    last.inputs[2] = result_of(int32_t(made.nodes.size()) - 1);
    if (random() % 2)
      last.inputs[3] = constant(0.0f);
    last.inputs[4] = constant(random() % 8 ? 1.0f : 0.25f);
    last.first = 5;
  }
  made.nodes.push_back(last);
  return made;
}

// Every kind, with all its options and flags.
inline std::vector<NodeCase> all_cases(Random &random) {
  std::vector<NodeCase> cases;
  const auto options = [&](uint32_t kind, uint32_t count, uint32_t flags = 1) {
    for (uint32_t option = 0; option < count; ++option)
      for (uint32_t flag = 0; flag < flags; ++flag)
        cases.push_back(make_case(random, kind, option, flag));
  };
  for (uint32_t option = 0; option < LANCER_COORDINATE_COUNT; ++option)
    options(LANCER_NODE_COORDINATE, LANCER_COORDINATE_COUNT, 2);
  for (int i = 0; i < 6; ++i)
    options(LANCER_NODE_ATTRIBUTE, 1, 8);
  for (uint32_t extension = 0; extension < 4; ++extension)
    for (uint32_t interpolation = 0; interpolation < 3; ++interpolation)
      for (const uint32_t straight : {0u, 256u})
        for (uint32_t option = 0; option < 4; ++option) {
          const uint32_t flags = extension | interpolation << 4 | straight;
          for (int i = 0; i < 4; ++i)
            cases.push_back(make_case(random, LANCER_NODE_IMAGE, option, flags));
          if (option < 3)
            cases.push_back(make_case(random, LANCER_NODE_ENVIRONMENT, option, flags));
        }
  options(LANCER_NODE_ALPHA, 1);
  for (int i = 0; i < 4; ++i)
    options(LANCER_NODE_MAPPING, 4);
  options(LANCER_NODE_TRANSFORM, 3);
  options(LANCER_NODE_MATH, LANCER_MATH_COUNT, 2);
  options(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_COUNT);
  options(LANCER_NODE_MIX, LANCER_MIX_COUNT, 4);
  options(LANCER_NODE_SEPARATE, 3);
  options(LANCER_NODE_COMBINE, 1);
  options(LANCER_NODE_GREY, 1);
  options(LANCER_NODE_FRESNEL, 1);
  options(LANCER_NODE_LAYER_WEIGHT, 2);
  for (int i = 0; i < 4; ++i)
    options(LANCER_NODE_NORMAL_MAP, 5, 2);
  for (int i = 0; i < 8; ++i)
    options(LANCER_NODE_BUMP, 1, 8);
  for (int i = 0; i < 4; ++i)
    options(LANCER_NODE_TANGENT, 4, 3);
  options(LANCER_NODE_CLAMP, 1);
  options(LANCER_NODE_DISPLACEMENT, 2);
  options(LANCER_NODE_GAMMA, 1);
  options(LANCER_NODE_INVERT, 1);
  options(LANCER_NODE_COLOR_MODEL, LANCER_COLOR_COUNT);
  for (int i = 0; i < 8; ++i)
    options(LANCER_NODE_SKY, LANCER_SKY_COUNT);
  options(LANCER_NODE_NOISE, LANCER_NOISE_COUNT, 64);
  for (uint32_t option = 0; option < LANCER_VORONOI_COUNT; ++option)
    for (uint32_t flags = random() % 7; flags < 512; flags += 7)
      cases.push_back(make_case(random, LANCER_NODE_VORONOI, option, flags));
  options(LANCER_NODE_GRADIENT, LANCER_GRADIENT_COUNT);
  options(LANCER_NODE_WAVE, LANCER_PROFILE_COUNT, 16);
  options(LANCER_NODE_MAGIC, 11, 2);
  for (int i = 0; i < 4; ++i) {
    options(LANCER_NODE_CHECKER, 1);
    options(LANCER_NODE_BRICK, 1);
    options(LANCER_NODE_GABOR, 2);
    options(LANCER_NODE_RADIAL_TILING, 2, 2);
    options(LANCER_NODE_WIREFRAME, 1, 2);
    options(LANCER_NODE_IES, 1);
  }
  for (uint32_t flags = 0; flags < 4; ++flags)
    for (const uint32_t color : {0u, uint32_t(LANCER_NOISE_COLOR)})
      cases.push_back(make_case(random, LANCER_NODE_WHITE_NOISE, 0, flags | color));
  for (uint32_t from = 0; from < 3; ++from)
    for (uint32_t to = 0; to < 3; ++to)
      for (uint32_t option = 0; option < 3; ++option)
        cases.push_back(make_case(random, LANCER_NODE_VECTOR_TRANSFORM, option, from | to << 2));
  for (int i = 0; i < 3; ++i)
    options(LANCER_NODE_CURVES, 2, 4);
  options(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_COUNT);
  options(LANCER_NODE_LIGHT_PATH, LANCER_PATH_COUNT);
  for (int i = 0; i < 4; ++i) {
    options(LANCER_NODE_OCCLUSION, 3, 4);
    options(LANCER_NODE_BEVEL, 3);
    options(LANCER_NODE_RAYCAST, 4, 8);
    options(LANCER_NODE_VOXELS, 3);
  }
  return cases;
}

} // namespace lancer_test
