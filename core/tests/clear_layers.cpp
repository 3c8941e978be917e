// Stacks of squares that an image cuts out completely, seen from above.
#include "foliage.h"

#include "integrator/sample.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// bump: whether u tilts the material's normal.
std::shared_ptr<const Scene> stack(Writing writing, uint32_t count, bool bump) {
  Description description;
  add_leaf_picture(description);
  std::vector<lancer_node> nodes = leaf_nodes(writing);
  lancer_lobe matt = lobe(LANCER_LAMBERT, 1.0f);
  matt.color = result_of(2);
  matt.weight = result_of(3);
  lancer_material material = black();
  material.name = "clear";
  material.lobes = &matt;
  material.lobe_count = 1;
  material.transmittance = result_of(5);
  if (bump) {
    nodes.push_back(node(LANCER_NODE_SEPARATE, 0, {result_of(0)}));
    nodes.push_back(node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(0.5f), result_of(6), constant(0.0f), constant(1.0f)}));
    material.normal = result_of(7);
  }
  material.nodes = nodes.data();
  material.node_count = uint32_t(nodes.size());
  add_material(description, material);
  // The whole of a square shows a corner of the image.
  Squares squares;
  for (uint32_t i = 0; i < count; ++i)
    squares.add({0.0, 0.0, 3.0f - 4.0f * float(i) / float(count)}, {3.0, 0.0, 0.0}, {0.0, 3.0, 0.0}, 0.2f);
  add_mesh(description, squares.mesh());
  lancer_instance instance = {};
  place(instance.matrix, 0, 0, 0, 1);
  instance.kind = LANCER_MESH;
  instance.slot_count = 1;
  const uint32_t slot = 0;
  add_instances(description, 1, &instance, 1, &slot, nullptr, 0);
  description.world = constant_sky(glm::vec3(1.0f));
  return commit(std::move(description), AcceleratorKind::Bvh, {});
}

SampleResult look(const Scene &scene, const IntegratorSettings &settings) {
  const Camera camera = camera_above(scene, 32);
  const SampleAddress address{5, 7, 0};
  SampleResult result;
  make_integrator(scene, camera, settings)->run({&address, 1}, {&result, 1}, nullptr);
  return result;
}

TEST(ClearLayers, ShowTheSkyUpToTheLimit) {
  for (const uint32_t count : {7u, 8u, 9u, 600u})
    for (const Writing writing : {Writing::Unknown, Writing::Plain}) {
      IntegratorSettings settings;
      settings.transparent_bounces = 8;
      EXPECT_EQ(look(*stack(writing, count, false), settings).radiance, glm::vec3(count <= 8 ? 1.0f : 0.0f)) << count;
    }
}

TEST(ClearLayers, HaveTheirBumpsInTheNormalPass) {
  IntegratorSettings settings;
  settings.alpha_threshold = 0.0f;
  settings.passes |= 1u << LANCER_PASS_NORMAL;
  const glm::vec3 one_by_one = look(*stack(Writing::Unknown, 3, true), settings).normal,
                  together = look(*stack(Writing::Plain, 3, true), settings).normal;
  EXPECT_GT(std::abs(one_by_one.x), 0.01f);
  // The same place and footprint: a few roundings of unit vectors.
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(together[axis], one_by_one[axis], 8 * 0x1p-24f);
}

} // namespace
} // namespace lancer_test
