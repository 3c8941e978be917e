// Scenes through the C interface alone, made of numbers that every machine reads alike, and rendered into a hash of all bits.
#pragma once

#include "bits_hash.h"
#include "lancer_probes.h"
#include "tiny_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>

namespace lancer_test {

// A random number generator of its own, the same everywhere.
class Dice {
public:
  uint32_t operator()() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return uint32_t(state_ >> 33);
  }
  // Returns a multiple of 1/256 in [0, 1).
  float share() { return float((*this)() >> 3 & 255u) * (1.0f / 256.0f); }
  // In sequence: compilers evaluate the arguments of a call in any order.
  std::array<double, 3> place(const std::array<double, 3> &from, const std::array<double, 3> &size) {
    std::array<double, 3> result = from;
    for (size_t i = 0; i < 3; ++i)
      result[i] += size[i] * double(share());
    return result;
  }
  lancer_parameter color() {
    const std::array<double, 3> c = place({}, {1.0, 1.0, 1.0});
    return parameter(float(c[0]), float(c[1]), float(c[2]));
  }

private:
  uint64_t state_ = 7;
};

inline lancer_parameter result_of(int32_t node) { return {{0, 0, 0}, node}; }

inline lancer_node node(uint32_t kind, uint32_t option = 0, std::initializer_list<lancer_parameter> inputs = {},
                        uint32_t flags = 0) {
  lancer_node n = {};
  n.kind = kind;
  n.option = option;
  n.flags = flags;
  std::fill(std::begin(n.inputs), std::end(n.inputs), parameter(0.0f));
  std::copy(inputs.begin(), inputs.end(), n.inputs);
  n.matrix[0] = n.matrix[5] = n.matrix[10] = 1.0f;
  return n;
}

inline lancer_material plain() {
  lancer_material material = {};
  material.name = "material";
  material.emission = material.transmittance = material.holdout = material.displacement = material.normal = parameter(0.0f);
  material.ambient = parameter(0.1f);
  return material;
}

// A lobe by the newest rules, which kernels of many lanes support; a diffuse one is smooth.
inline lancer_lobe newest(uint32_t kind, float color, float roughness = 0.0f) {
  lancer_lobe one = lobe(kind, color, roughness);
  one.rules = LANCER_RULES_BLENDER_45;
  return one;
}

inline lancer_light lamp(uint32_t kind, double x, double y, double z, float strength) {
  lancer_light light = point_light();
  place(light.matrix, x, y, z);
  light.kind = kind;
  light.emission[0] = strength;
  light.emission[1] = 0.75f * strength;
  light.emission[2] = 0.5f * strength;
  light.spot_angle = 1.25f;
  light.spot_blend = 0.5f;
  light.spread = 3.1415927f;
  light.size[0] = light.size[1] = 1.0f;
  return light;
}

// Rotates a placement about z and x, by angles of triangles with sides 3, 4 and 5.
inline void tilt(double m[12]) {
  const double turned[9] = {0.6, -0.64, 0.48, 0.8, 0.48, -0.36, 0.0, 0.6, 0.8}, scale = m[0];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      m[4 * row + column] = scale * turned[3 * row + column];
}

class Stand {
public:
  lancer_camera camera = make_camera(16, 12);
  lancer_settings settings = make_settings();
  BitsHash hash;
  uint64_t vertices = 0;

  Stand() { lancer_scene_create(&scene_); }
  ~Stand() {
    lancer_session_destroy(session_);
    lancer_scene_destroy(scene_);
  }
  Stand(const Stand &) = delete;
  Stand &operator=(const Stand &) = delete;

  uint32_t material(std::vector<lancer_lobe> lobes, lancer_material material = plain(), std::vector<lancer_node> nodes = {}) {
    material.lobes = lobes.data();
    material.lobe_count = uint32_t(lobes.size());
    material.nodes = nodes.data();
    material.node_count = uint32_t(nodes.size());
    EXPECT_EQ(lancer_scene_add_material(scene_, &material), LANCER_OK) << lancer_last_error();
    return materials_++;
  }
  uint32_t glow(float radiance) {
    lancer_material shining = plain();
    shining.emission = parameter(radiance, 0.75f * radiance, 0.5f * radiance);
    return material({}, shining);
  }

  lancer_instance &place(uint32_t kind, uint32_t material, double x, double y, double z, double scale = 1.0) {
    lancer_instance instance = {};
    lancer_test::place(instance.matrix, x, y, z, scale);
    instance.kind = kind;
    instance.first_slot = uint32_t(slots_.size());
    instance.slot_count = 1;
    instance.object_index = uint32_t(instances_.size());
    slots_.push_back(material);
    instances_.push_back(instance);
    return instances_.back();
  }
  lancer_instance &place(uint32_t kind, uint32_t material, const std::array<double, 3> &at) {
    return place(kind, material, at[0], at[1], at[2]);
  }
  void floor(float color = 0.5f) { place(LANCER_PLANE, material({newest(LANCER_DIFFUSE, color)}), 0, 0, 0); }

  void add(const lancer_mesh &mesh) { EXPECT_EQ(lancer_scene_add_mesh(scene_, &mesh), LANCER_OK) << lancer_last_error(); }
  void add(const lancer_image &image) { EXPECT_EQ(lancer_scene_add_image(scene_, &image), LANCER_OK) << lancer_last_error(); }
  void add(const lancer_light &light) { EXPECT_EQ(lancer_scene_add_light(scene_, &light), LANCER_OK) << lancer_last_error(); }
  void add(const lancer_world &world) { EXPECT_EQ(lancer_scene_set_world(scene_, &world), LANCER_OK) << lancer_last_error(); }
  void sky(float r, float g, float b) {
    lancer_world world = {};
    world.radiance = parameter(r, g, b);
    add(world);
  }

  void commit(uint32_t accelerator = LANCER_BVH) {
    lancer_scene_add_instances(scene_, uint32_t(instances_.size()), instances_.data(), uint32_t(slots_.size()), slots_.data(),
                               nullptr, 0);
    ASSERT_EQ(lancer_scene_commit(scene_, accelerator, 2), LANCER_OK) << lancer_last_error();
    lancer_status status;
    while ((status = lancer_scene_wait(scene_, 50)) == LANCER_RUNNING)
      ;
    ASSERT_EQ(status, LANCER_OK) << lancer_last_error();
  }

  // Hashes every pass of samples and the error. refine: number of refinement rounds. The picture rendered alone, by kernels of
  // many lanes where possible, must have the same bits.
  void render(int refine = 0) {
    const uint32_t passes = settings.passes;
    run(refine);
    for (uint32_t pass = 0; pass <= LANCER_PASS_ERROR; ++pass)
      for (const float value : read(pass))
        hash.add(value);
    lancer_error error;
    ASSERT_EQ(lancer_session_error(session_, 0.95, &error), LANCER_OK) << lancer_last_error();
    for (const double told : {error.error, error.low, error.high, error.cannot_exclude, error.clipped, error.missing})
      hash.add(told);
    const std::vector<float> with = read(LANCER_PASS_COMBINED);
    settings.passes = 1u << LANCER_PASS_COMBINED;
    run(refine);
    settings.passes = passes;
    EXPECT_EQ(std::memcmp(with.data(), read(LANCER_PASS_COMBINED).data(), with.size() * sizeof(float)), 0);
    lancer_statistics statistics;
    ASSERT_EQ(lancer_session_statistics(session_, &statistics), LANCER_OK) << lancer_last_error();
    vertices += statistics.vertices;
  }

  // Hashes a node's values over the unit square.
  void look_at(uint32_t material, uint32_t number) {
    std::vector<float> uv, values(4 * 64);
    for (uint32_t i = 0; i < 64; ++i)
      uv.insert(uv.end(), {float(i % 8) * 0.125f + 0.0625f, float(i / 8) * 0.125f + 0.03125f});
    ASSERT_EQ(lancer_probe_node(scene_, material, number, 64, uv.data(), values.data()), LANCER_OK) << lancer_last_error();
    for (const float value : values)
      hash.add(value != value ? 0.0f : value);
  }

private:
  void run(int refine) {
    lancer_session_destroy(session_);
    session_ = 0;
    settings.refines = refine > 0;
    ASSERT_EQ(lancer_session_create(scene_, &camera, &settings, &session_), LANCER_OK) << lancer_last_error();
    ASSERT_EQ(lancer_session_render(session_, 0, refine > 0 ? 4 : settings.samples), LANCER_OK) << lancer_last_error();
    ASSERT_EQ(finish(session_), LANCER_OK);
    for (; refine > 0 && lancer_session_refine(session_, 0.01, 0.95) == LANCER_OK; --refine)
      ASSERT_EQ(finish(session_), LANCER_OK);
  }

  std::vector<float> read(uint32_t pass) const {
    const uint32_t of_one[] = {LANCER_PASS_DEPTH, LANCER_PASS_OBJECT_INDEX,    LANCER_PASS_MATERIAL_INDEX,
                               LANCER_PASS_MIST,  LANCER_PASS_DENOISING_DEPTH, LANCER_PASS_ERROR};
    const uint32_t channels = pass == LANCER_PASS_COMBINED                                                ? 4
                              : std::find(std::begin(of_one), std::end(of_one), pass) != std::end(of_one) ? 1
                                                                                                          : 3;
    std::vector<float> values(size_t(camera.region_width) * camera.region_height * channels);
    EXPECT_EQ(lancer_session_read(session_, pass, values.data(), values.size()), LANCER_OK) << lancer_last_error();
    return values;
  }

  lancer_scene scene_ = 0;
  lancer_session session_ = 0;
  uint32_t materials_ = 0;
  std::vector<lancer_instance> instances_;
  std::vector<uint32_t> slots_;
};

// A wavy sheet over -1 ... 1 with UVs, with the same corners on every machine.
struct Sheet {
  std::vector<float> positions, uvs;
  std::vector<uint32_t> triangles;

  explicit Sheet(uint32_t side, float height = 0.25f) {
    for (uint32_t y = 0; y <= side; ++y)
      for (uint32_t x = 0; x <= side; ++x) {
        const float u = float(x) / float(side), v = float(y) / float(side);
        positions.insert(positions.end(), {2.0f * u - 1.0f, 2.0f * v - 1.0f, height * (u * (1.0f - u) - v * (1.0f - v))});
      }
    for (uint32_t y = 0; y < side; ++y)
      for (uint32_t x = 0; x < side; ++x) {
        const uint32_t a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
        for (const uint32_t corner : {a, b, d, a, d, c}) {
          triangles.push_back(corner);
          uvs.insert(uvs.end(), {0.5f * positions[3 * corner] + 0.5f, 0.5f * positions[3 * corner + 1] + 0.5f});
        }
      }
  }

  lancer_mesh mesh() const {
    lancer_mesh mesh = {};
    mesh.name = "sheet";
    mesh.positions = positions.data();
    mesh.triangles = triangles.data();
    mesh.uvs = uvs.data();
    mesh.vertex_count = uint32_t(positions.size() / 3);
    mesh.triangle_count = uint32_t(triangles.size() / 3);
    return mesh;
  }
};

} // namespace lancer_test
