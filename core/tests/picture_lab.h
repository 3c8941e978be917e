// Small complete renders through the C interface: a scene of few objects, and the passes of the result.
#pragma once

#include "nodes_lab.h"
#include "tiny_scene.h"

#include <glm/gtc/matrix_transform.hpp>

namespace lancer_test {

inline glm::dmat4 moved(double x, double y, double z) { return glm::translate(glm::dmat4(1.0), glm::dvec3(x, y, z)); }
// Rotation about an axis, in degrees.
inline glm::dmat4 turned(double angle, double x, double y, double z) {
  return glm::rotate(glm::dmat4(1.0), glm::radians(angle), glm::dvec3(x, y, z));
}

inline void to_rows(const glm::dmat4 &m, double rows[12]) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      rows[row * 4 + column] = m[column][row];
}

// Local z faces this direction, local x is horizontal.
inline glm::dmat4 facing(const glm::dvec3 &there) {
  const glm::dvec3 z = glm::normalize(there), up = std::abs(z.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(up, z));
  return glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(0, 0, 0, 1));
}

class Studio {
public:
  lancer_camera camera = {};
  lancer_settings settings = make_settings();

  Studio() {
    lancer_scene_create(&scene_);
    // One sample at the centre of a pixel equals the pixel, except for a thousandth of its width.
    settings.pixel_filter = LANCER_FILTER_BOX;
    settings.filter_width = 1e-3f;
    settings.samples = 1;
    settings.max_bounces = 0;
    look({0, 0, 1}, {0, 0, 0});
  }
  ~Studio() {
    lancer_session_destroy(session_);
    lancer_scene_destroy(scene_);
  }

  // A parallel view of this many pixels squared and this width.
  void look(const glm::dvec3 &eye, const glm::dvec3 &target, uint32_t pixels = 1, double width = 1e-6) {
    const glm::dmat4 m = facing(eye - target);
    to_rows(moved(eye.x, eye.y, eye.z) * m, camera.matrix);
    camera.kind = LANCER_ORTHOGRAPHIC;
    camera.width = camera.height = camera.region_width = camera.region_height = pixels;
    const double half = 0.5 * width, window[4] = {-half, half, -half, half};
    std::copy(window, window + 4, camera.window);
    camera.clip_start = 0.0;
    camera.clip_end = 1e6;
    camera.focal_distance = camera.aperture_ratio = 1.0;
  }

  // Adds a material with these lobes and the rest of the given one. Returns its number.
  uint32_t add(std::vector<lancer_lobe> lobes, lancer_material material = black(), std::vector<lancer_node> nodes = {}) {
    material.name = "material";
    material.lobes = lobes.data();
    material.lobe_count = uint32_t(lobes.size());
    material.nodes = nodes.data();
    material.node_count = uint32_t(nodes.size());
    EXPECT_EQ(lancer_scene_add_material(scene_, &material), LANCER_OK) << lancer_last_error();
    return materials_++;
  }

  void add(const lancer_mesh &mesh) { EXPECT_EQ(lancer_scene_add_mesh(scene_, &mesh), LANCER_OK) << lancer_last_error(); }

  // Adds an object; the returned reference is valid until the next call.
  lancer_instance &place(uint32_t kind, uint32_t material, const glm::dmat4 &m = glm::dmat4(1.0)) {
    return place(kind, {material}, m);
  }
  lancer_instance &place(uint32_t kind, std::initializer_list<uint32_t> materials, const glm::dmat4 &m = glm::dmat4(1.0)) {
    lancer_instance instance = {};
    to_rows(m, instance.matrix);
    instance.kind = kind;
    instance.first_slot = uint32_t(slots_.size());
    instance.slot_count = uint32_t(materials.size());
    slots_.insert(slots_.end(), materials);
    instances_.push_back(instance);
    return instances_.back();
  }

  // Returns parallel light of this irradiance from this direction.
  lancer_light sun(const glm::dvec3 &towards, float irradiance = 1.0f) const {
    lancer_light light = point_light();
    to_rows(facing(towards), light.matrix);
    light.kind = LANCER_SUN;
    std::fill(light.emission, light.emission + 3, irradiance);
    return light;
  }
  void add(const lancer_image &image) { EXPECT_EQ(lancer_scene_add_image(scene_, &image), LANCER_OK) << lancer_last_error(); }
  void add(const lancer_world &world) { EXPECT_EQ(lancer_scene_set_world(scene_, &world), LANCER_OK) << lancer_last_error(); }
  void add(const lancer_light &light) { EXPECT_EQ(lancer_scene_add_light(scene_, &light), LANCER_OK) << lancer_last_error(); }

  // by_nodes: the same radiance as the result of a node, which makes it a light to sample.
  void sky(float r, float g, float b, uint32_t hidden_from = 0, bool by_nodes = false) {
    lancer_node nodes[2] = {
        node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_GENERATED),
        node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY_ADD, {result_of(0), constant(0.0f), constant(r, g, b)})};
    lancer_world world = {};
    world.radiance = by_nodes ? result_of(1) : constant(r, g, b);
    world.nodes = nodes;
    world.node_count = by_nodes ? 2 : 0;
    world.hidden_from = hidden_from;
    world.map_resolution = 16;
    EXPECT_EQ(lancer_scene_set_world(scene_, &world), LANCER_OK) << lancer_last_error();
  }

  // Renders once. Then read() returns the passes.
  void render() {
    lancer_scene_add_instances(scene_, uint32_t(instances_.size()), instances_.data(), uint32_t(slots_.size()), slots_.data(),
                               nullptr, 0);
    ASSERT_EQ(lancer_scene_commit(scene_, LANCER_BVH, 1), LANCER_OK) << lancer_last_error();
    while (lancer_scene_wait(scene_, 50) == LANCER_RUNNING)
      ;
    ASSERT_EQ(lancer_session_create(scene_, &camera, &settings, &session_), LANCER_OK) << lancer_last_error();
    ASSERT_EQ(lancer_session_render(session_, 0, settings.samples), LANCER_OK) << lancer_last_error();
    ASSERT_EQ(finish(session_), LANCER_OK);
  }

  std::vector<float> read(uint32_t pass, uint32_t channels) const {
    std::vector<float> out(size_t(camera.region_width) * camera.region_height * channels);
    EXPECT_EQ(lancer_session_read(session_, pass, out.data(), out.size()), LANCER_OK) << lancer_last_error();
    return out;
  }

  // Returns the mean over all pixels.
  glm::vec3 color(uint32_t pass = LANCER_PASS_COMBINED) const {
    const uint32_t channels = pass == LANCER_PASS_COMBINED ? 4 : 3;
    return mean(read(pass, channels), channels);
  }
  float alpha() const { return mean(read(LANCER_PASS_COMBINED, 4), 4).w; }
  float number(uint32_t pass) const { return mean(read(pass, 1), 1).x; }

  lancer_statistics statistics() const {
    lancer_statistics out;
    EXPECT_EQ(lancer_session_statistics(session_, &out), LANCER_OK) << lancer_last_error();
    return out;
  }

private:
  static glm::vec4 mean(const std::vector<float> &values, uint32_t channels) {
    glm::dvec4 sum(0.0);
    for (size_t i = 0; i < values.size(); ++i)
      sum[int(i % channels)] += double(values[i]);
    return glm::vec4(sum * (double(channels) / double(values.size())));
  }

  lancer_scene scene_ = 0;
  lancer_session session_ = 0;
  uint32_t materials_ = 0;
  std::vector<lancer_instance> instances_;
  std::vector<uint32_t> slots_;
};

// A lobe by the newest rules.
inline lancer_lobe newest(uint32_t kind, float color, float roughness = 0.3f) {
  lancer_lobe result = lobe(kind, color, roughness);
  result.rules = LANCER_RULES_BLENDER_45;
  return result;
}

// A material that transmits this share of light straight through, and scatters none.
inline lancer_material pane(float transmittance) {
  lancer_material material = black();
  material.transmittance = constant(transmittance);
  return material;
}

inline lancer_material glow(float radiance, uint32_t flags = 0) {
  lancer_material material = black();
  material.emission = constant(radiance);
  material.flags = flags;
  return material;
}

} // namespace lancer_test
