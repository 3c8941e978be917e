// Nodes with a scene of their own: one placed triangle with attributes, images, and any program.
#pragma once

#include "accel/accelerator.h"
#include "compile/scene.h"
#include "compile/steps.h"
#include "geometry_lab.h"
#include "nodes/run.h"
#include "scene/camera.h"
#include "scene/fill.h"
#include "scene/messages.h"

#include <gtest/gtest.h>

namespace lancer_test {

using namespace lancer;

inline lancer_parameter constant(float x, float y, float z) { return {{x, y, z}, -1}; }
inline lancer_parameter constant(float x) { return constant(x, x, x); }
inline lancer_parameter result_of(int32_t node) { return {{0, 0, 0}, node}; }

inline lancer_node node(uint32_t kind, uint32_t option = 0, std::initializer_list<lancer_parameter> inputs = {}) {
  lancer_node n = {};
  n.kind = kind;
  n.option = option;
  for (lancer_parameter &input : n.inputs)
    input = constant(0.0f);
  std::copy(inputs.begin(), inputs.end(), n.inputs);
  n.matrix[0] = n.matrix[5] = n.matrix[10] = 1.0f;
  return n;
}

// A material without lobes, with every value the constant 0.
inline lancer_material black() {
  lancer_material material = {};
  material.emission = material.transmittance = material.holdout = material.ambient = material.displacement = material.normal =
      constant(0.0f);
  return material;
}

inline lancer_node named(lancer_node n, const char *name) {
  n.name = name;
  return n;
}

inline lancer_node flagged(lancer_node n, uint32_t flags) {
  n.flags = flags;
  return n;
}

class Stage {
public:
  Description description;
  Camera *camera = nullptr;
  float footprint = 0.0f;
  glm::vec3 wo{0, 0, 1};
  Normalisation normalisation;

  // A triangle in the plane z = 0 of its object, placed by rows.
  explicit Stage(const std::vector<double> &rows = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}) : Stage(triangle(), rows) {}

  Stage(const lancer_mesh &mesh, const std::vector<double> &rows) {
    add_mesh(description, mesh);
    Instance instance;
    instance.place(Affine::from_rows(rows.data()));
    description.instances.push_back(instance);
  }

  static lancer_mesh triangle() {
    static const float positions[] = {0, 0, 0, 2, 0, 0, 0, 2, 0};
    static const uint32_t corners[] = {0, 1, 2};
    static const float uvs[] = {0, 0, 1, 0, 0, 1};
    lancer_mesh mesh = {};
    mesh.name = "triangle";
    mesh.positions = positions;
    mesh.triangles = corners;
    mesh.uvs = uvs;
    mesh.vertex_count = 3;
    mesh.triangle_count = 1;
    return mesh;
  }

  // Moves everything to the normalised world.
  void normalise(const glm::dvec3 &centre, double scale) {
    normalisation = {centre, scale};
    Instance &instance = description.instances[0];
    instance.place(normalisation.to_normalised(instance.to_world));
  }

  Surface surface(double u, double v, uint32_t primitive = 0) const {
    Surface s;
    s.instance = 0;
    s.primitive = primitive;
    s.bary = {u, v};
    const Mesh &mesh = *description.meshes[0];
    const glm::dvec3 v0(mesh.vertex(primitive, 0)), v1(mesh.vertex(primitive, 1)), v2(mesh.vertex(primitive, 2));
    const Instance &instance = description.instances[0];
    s.p = instance.to_world.point((1.0 - u - v) * v0 + u * v1 + v * v2);
    const auto unit = [&](const glm::dvec3 &n) {
      return glm::vec3(glm::normalize(glm::transpose(instance.to_object.linear) * n));
    };
    s.ng = unit(glm::cross(v1 - v0, v2 - v0));
    const glm::vec3 n = interpolated_normal(mesh, instance.shading, primitive, s.bary);
    s.ns = n == glm::vec3(0.0f) ? s.ng : unit(glm::dvec3(n));
    return s;
  }

  // Returns the value of the last node.
  glm::vec4 value(const std::vector<lancer_node> &nodes, double u = 0.25, double v = 0.5) {
    const Surface s = surface(u, v);
    return value_at(nodes, &s);
  }

  glm::vec4 value_at(const std::vector<lancer_node> &nodes, const Surface *s) {
    const Program program = read_program(description.images, "test", nodes.data(), uint32_t(nodes.size()));
    Parameter last;
    last.node = int32_t(nodes.size()) - 1;
    const DescribedGeometry geometry(description);
    NodeContext context;
    context.geometry = &geometry;
    context.normalisation = &normalisation;
    context.camera = camera;
    context.surface = s;
    context.wo = wo;
    context.footprint = footprint;
    std::vector<glm::vec4> values(program.value_count(), glm::vec4(NAN));
    run(program, program.schedule(std::span(&last, 1)), context, values);
    return values[nodes.size() - 1];
  }
};

// Texels from the lowest row up, linear, with colours multiplied by alpha. Valid as long as they are neither changed nor moved.
template <class Texel>
lancer_image image_of(const std::vector<Texel> &texels, uint32_t width, uint32_t height, uint32_t channels = 4) {
  lancer_image image = {};
  image.name = "picture";
  image.texels = texels.data();
  image.width = width;
  image.height = height;
  image.channels = channels;
  image.kind = sizeof(Texel) == 1 ? LANCER_TEXEL_U8 : sizeof(Texel) == 2 ? LANCER_TEXEL_U16 : LANCER_TEXEL_FLOAT;
  image.matrix[0] = image.matrix[4] = image.matrix[8] = 1.0f;
  return image;
}

// Adds an image, which the program keeps.
inline void hold(Program &program, Image image) {
  program.images.push_back(image);
  program.held.push_back(std::make_shared<const Image>(std::move(image)));
}

// Displaces the meshes without those of a scene before.
inline void displace(Description &description, const BuildContext &context) {
  MadeMeshes made;
  lancer::displace(description, context, made);
}

// A world of one radiance.
inline Given<World> constant_sky(const glm::vec3 &radiance) {
  World world;
  world.radiance.value = radiance;
  return Given<World>(std::move(world));
}

// Returns the image as scenes read it.
inline Image kept_image(const lancer_image &image) {
  Messages messages;
  return read_image(image, 0, messages);
}

// An image of floats whose colour is the position of the texel's centre: u, v, 0, 1.
inline void add_gradient(Description &description, uint32_t width, uint32_t height, uint32_t tile = 0) {
  std::vector<float> texels;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      texels.insert(texels.end(), {(float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height), float(tile), 1.0f});
  lancer_image image = image_of(texels, width, height);
  image.tile = tile;
  add_image(description, image);
}

// Numbers of order 1 after a few float operations: some units in the last place.
inline void expect_near(const glm::vec3 &got, const glm::vec3 &expected, float tolerance = 2e-6f) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(got[i], expected[i], tolerance) << "component " << i;
}

} // namespace lancer_test
