// Paths under a sky image, over surfaces with images: lanes and single samples have the same bits.
#include "random_scenes.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// Noise: bytes with a curve, or floats of which a few are bright. beyond: alpha is sometimes below 0 or above 1.
void add_image(Studio &studio, Random &random, uint32_t kind, bool beyond = false) {
  constexpr uint32_t width = 32, height = 16;
  std::vector<uint8_t> bytes(width * height * 4);
  std::vector<float> floats(bytes.size());
  for (size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = uint8_t(random());
    floats[i] = i % 4 == 3 ? number(random, -0.5f, 1.5f) : random() % 64 ? number(random) : 20.0f;
  }
  const bool small = kind == LANCER_TEXEL_U8;
  lancer_image image = small ? image_of(bytes, width, height) : image_of(floats, width, height);
  image.alpha = small || beyond ? LANCER_ALPHA_STRAIGHT : LANCER_ALPHA_NONE;
  image.transfer = small ? LANCER_TRANSFER_SRGB : LANCER_TRANSFER_LINEAR;
  studio.add(image);
}

uint32_t add_pictured(Studio &studio, Random &random, uint32_t image) {
  lancer_node picture = flagged(node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, {result_of(0)}), random() % 3 | 256);
  picture.image = image;
  picture.image_count = 1;
  // Alpha unchanged, or clamped by a mix.
  const int32_t share = random() % 2 ? 2 : 3;
  const std::vector<lancer_node> nodes = {named(node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV), ""), picture,
                                          node(LANCER_NODE_ALPHA, 0, {result_of(1)}),
                                          flagged(node(LANCER_NODE_MATH, LANCER_MATH_ADD, {result_of(2), constant(0.0f)}), 1),
                                          node(LANCER_NODE_MATH, LANCER_MATH_SUBTRACT, {constant(1.0f), result_of(share)})};
  // Nodes that decide more than the colour.
  lancer_material material = black();
  if (random() % 4 == 0)
    material.transmittance = result_of(1);
  else if (random() % 2)
    material.transmittance = result_of(4);
  if (random() % 2) {
    lancer_principled layers = principled(random);
    layers.base_color = result_of(1);
    lancer_lobe layered = lobe(LANCER_PRINCIPLED, 1.0f);
    layered.weight = random() % 2 ? result_of(share) : constant(0.7f, 0.6f, 0.9f);
    layered.principled = &layers;
    return studio.add({layered}, material, nodes);
  }
  // Not rough, so that kernels support it.
  lancer_lobe matte = lobe(LANCER_DIFFUSE, 0.8f, 0.0f);
  matte.rules = LANCER_RULES_BLENDER_45;
  matte.color = result_of(1);
  if (random() % 2)
    matte.weight = result_of(share);
  return studio.add({matte}, material, nodes);
}

void add_sky(Studio &studio, uint32_t seed) {
  std::vector<lancer_node> nodes = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_GENERATED)};
  if (seed % 2)
    nodes.push_back(node(LANCER_NODE_MAPPING, LANCER_MAPPING_POINT,
                         {result_of(0), constant(0.1f), constant(0.3f, -0.2f, 1.0f), constant(1.0f)}));
  lancer_node picture =
      node(LANCER_NODE_ENVIRONMENT, LANCER_ENVIRONMENT_EQUIRECTANGULAR, {result_of(int32_t(nodes.size()) - 1)});
  picture.image = 0;
  picture.image_count = 1;
  nodes.push_back(picture);
  const lancer_parameter seen = result_of(int32_t(nodes.size()) - 1);
  // Sometimes a node that only the general code evaluates.
  if (seed % 3)
    nodes.push_back(node(LANCER_NODE_VECTOR_MATH, seed % 3 == 1 ? LANCER_VECTOR_MULTIPLY : LANCER_VECTOR_ADD,
                         {seen, constant(0.4f, 0.5f, 0.6f)}));
  lancer_world world = {};
  world.radiance = result_of(int32_t(nodes.size()) - 1);
  world.nodes = nodes.data();
  world.node_count = uint32_t(nodes.size());
  world.hidden_from = seed % 7 == 0 ? uint32_t(LANCER_RAY_GLOSSY) : 0u;
  studio.add(world);
}

std::vector<float> picture(uint32_t seed, uint32_t passes) {
  Random random(seed);
  Studio studio;
  studio.settings.passes = passes;
  studio.settings.samples = 4;
  studio.settings.max_bounces = 4;
  studio.settings.seed = seed;
  studio.settings.threads = 2;
  studio.settings.film_transparent = seed % 5 == 0;
  add_image(studio, random, LANCER_TEXEL_FLOAT);
  add_image(studio, random, LANCER_TEXEL_U8);
  add_image(studio, random, LANCER_TEXEL_U8);
  add_image(studio, random, LANCER_TEXEL_FLOAT, true);
  const Ball ball;
  lancer_mesh mesh = ball.mesh(true);
  std::vector<float> uvs(mesh.triangle_count * 6);
  for (float &uv : uvs)
    uv = number(random, -1.0f, 2.0f);
  mesh.uvs = uvs.data();
  studio.add(mesh);
  mesh.uvs = nullptr;
  studio.add(mesh);
  place_balls(studio, random, 4, [&] { return add_pictured(studio, random, 1 + random() % 3); });
  lancer_light sun = studio.sun({0.5, -0.3, 1.0}, 0.7f);
  sun.sun_angle = seed % 4 ? 0.3f : 0.0f;
  sun.sun_flat = seed % 8 < 4;
  if (seed % 3)
    studio.add(sun);
  add_sky(studio, seed);
  studio.look({2, -9, 6}, {0, 0, -0.5}, 48, 12.0);
  studio.render();
  return studio.read(LANCER_PASS_COMBINED, 4);
}

// Also with a film that is transparent to the sky.
TEST(PathPictures, ThePictureIsTheSameOneByOne) { expect_the_same_one_by_one(40, 0.005, picture); }

} // namespace
} // namespace lancer_test
