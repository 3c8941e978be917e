// Detection of surfaces that an image cuts out.
#include "foliage.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// The cutout of a leaf, and the description that it refers to.
struct Leaf : Cutout {
  Description description;

  explicit Leaf(Writing writing, float shines = 0.0f, void (*change)(Material &) = nullptr) {
    add_leaf_picture(description);
    add_foliage_materials(description, writing, shines);
    if (change) {
      Material material = *description.materials[0];
      change(material);
      description.materials[0] = Given<Material>(std::move(material));
    }
    static_cast<Cutout &>(*this) = make_cutout(*description.materials[0]);
  }
};
Leaf changed(void (*change)(Material &)) { return Leaf(Writing::Plain, 0.0f, change); }

TEST(Cutouts, KnownByTheirNodes) {
  const Leaf plain(Writing::Plain);
  EXPECT_TRUE(plain.alpha.known() && plain.painted && plain.may_end && plain.ends_with_alpha);
  EXPECT_EQ(plain.alpha.image->texels, plain.description.images[0]->texels);
  EXPECT_FALSE(plain.alpha.clamped);
  const Leaf mixed(Writing::Mixed);
  EXPECT_TRUE(mixed.alpha.known() && mixed.alpha.clamped && mixed.may_end && mixed.ends_with_alpha);
  // Alpha from nodes that depend on the place in a triangle only; and on more.
  const Leaf disguised(Writing::Disguised), anywhere(Writing::Unknown);
  EXPECT_TRUE(!disguised.alpha.known() && disguised.painted && disguised.may_end);
  EXPECT_TRUE(!anywhere.alpha.known() && !anywhere.painted && !anywhere.may_end);
}

TEST(Cutouts, SomethingMayBeLeftWhereAlphaIs0) {
  // The surface emits, scatters by another weight, or is a holdout.
  EXPECT_FALSE(Leaf(Writing::Plain, 1.0f).may_end);
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

} // namespace
} // namespace lancer_test
