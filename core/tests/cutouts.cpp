// Surfaces that a picture cuts out: which are known as such.
#include "foliage.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

Cutout cutout_of(Writing writing, float shines = 0.0f, void (*change)(Material &) = nullptr) {
  Description description;
  add_leaf_picture(description);
  add_foliage_materials(description, writing, shines);
  if (change)
    change(description.materials[0]);
  return make_cutouts(description.materials, description.images)[0];
}
Cutout changed(void (*change)(Material &)) { return cutout_of(Writing::Plain, 0.0f, change); }

TEST(Cutouts, KnownByTheirNodes) {
  const Cutout plain = cutout_of(Writing::Plain);
  EXPECT_TRUE(plain.alpha.known() && plain.painted && plain.may_end && plain.ends_with_alpha);
  EXPECT_EQ(plain.alpha.image, 0u);
  EXPECT_FALSE(plain.alpha.clamped);
  const Cutout mixed = cutout_of(Writing::Mixed);
  EXPECT_TRUE(mixed.alpha.known() && mixed.alpha.clamped && mixed.may_end && mixed.ends_with_alpha);
  // What the nodes say, at a place of a triangle; and more than that.
  const Cutout disguised = cutout_of(Writing::Disguised), anywhere = cutout_of(Writing::Unknown);
  EXPECT_TRUE(!disguised.alpha.known() && disguised.painted && disguised.may_end);
  EXPECT_TRUE(!anywhere.alpha.known() && !anywhere.painted && !anywhere.may_end);
}

TEST(Cutouts, SomethingMayBeLeftWhereAlphaIs0) {
  // The surface shines, scatters by another weight, or cuts a hole.
  EXPECT_FALSE(cutout_of(Writing::Plain, 1.0f).may_end);
  EXPECT_FALSE(changed([](Material &material) { material.lobes[0].weight.node = -1; }).may_end);
  EXPECT_FALSE(changed([](Material &material) { material.lobes[0].weight.node = 2; }).ends_with_alpha);
  EXPECT_FALSE(changed([](Material &material) { material.holdout.value = glm::vec3(1.0f); }).may_end);
}

TEST(Cutouts, OtherFormulas) {
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[5].option = LANCER_MATH_ADD; }).alpha.known());
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[5].flags = 1; }).alpha.known());
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[5].inputs[0].value = glm::vec3(0.5f); }).alpha.known());
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[2].option = LANCER_PROJECT_BOX; }).alpha.known());
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[2].option = LANCER_PROJECT_BOX; }).painted);
}

// As kernels look it up. One of the materials that they shade.
ColorPicture looked_up(Writing writing, void (*change)(Material &) = nullptr) {
  Description description;
  add_leaf_picture(description);
  add_foliage_materials(description, writing);
  if (change)
    change(description.materials[0]);
  std::vector<WideMaterial> wide(description.materials.size());
  wide[0].nodes = 1;
  return make_color_pictures(description.materials, wide, description.images)[0];
}

TEST(Cutouts, KernelsKnowThemByTheSameNodes) {
  for (const Writing writing : {Writing::Plain, Writing::Mixed}) {
    const ColorPicture leaf = looked_up(writing);
    EXPECT_TRUE(leaf.image && leaf.covers && leaf.clears);
    EXPECT_EQ(leaf.clamped, writing == Writing::Mixed);
    EXPECT_EQ(leaf.whole, 1.0f);
  }
  // A part of it that is always clear.
  const ColorPicture half = looked_up(Writing::Plain, [](Material &m) { m.program.nodes[5].inputs[0].value.x = 0.5f; });
  EXPECT_TRUE(half.image);
  EXPECT_EQ(half.whole, 0.5f);
  // What only the nodes know.
  EXPECT_FALSE(looked_up(Writing::Disguised).image);
  EXPECT_FALSE(looked_up(Writing::Mixed, [](Material &m) { m.program.nodes[4].inputs[1].value.x = 0.5f; }).image);
  EXPECT_FALSE(looked_up(Writing::Mixed, [](Material &m) { m.program.nodes[5].flags = 1; }).image);
  // Alpha as it is and clamped, and the alpha of something else.
  EXPECT_FALSE(looked_up(Writing::Mixed, [](Material &m) { m.lobes[0].weight.node = 3; }).image);
  EXPECT_FALSE(looked_up(Writing::Plain, [](Material &m) { m.program.nodes[3].inputs[0].node = 0; }).image);
}

} // namespace
} // namespace lancer_test
