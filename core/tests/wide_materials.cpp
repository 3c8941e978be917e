// What kernels know of materials, and what each side of glass is.
#include "scene/wide_materials.h"

#include <gtest/gtest.h>
#include <memory>

namespace lancer {
namespace {

Material layered(PrincipledDescription p) {
  Material material;
  LobeDescription &lobe = material.lobes.emplace_back();
  lobe.kind = LobeKind::Principled;
  lobe.principled = std::make_shared<PrincipledDescription>(std::move(p));
  material.ready = make_ready_lobes(material);
  return material;
}
PrincipledDescription glass(float roughness) {
  PrincipledDescription p;
  p.roughness = Parameter{glm::vec3(roughness)};
  p.transmission = Parameter{glm::vec3(1.0f)};
  p.ior = Parameter{glm::vec3(1.25f)};
  return p;
}

TEST(WideMaterials, GlassHasARecordForEachSide) {
  PrincipledDescription mirror;
  mirror.metallic = Parameter{glm::vec3(1.0f)};
  mirror.roughness = Parameter{glm::vec3(0.0f)};
  const std::vector<Material> materials = {layered(glass(0.3f)), layered(mirror), layered(glass(0.0f))};
  const std::vector<WideMaterial> wide = make_wide_materials(materials);
  ASSERT_EQ(wide.size(), 5u);
  for (const size_t i : {0u, 2u}) {
    ASSERT_EQ(wide[i].count, 1u);
    EXPECT_EQ(wide[i].transmits, 1u);
    const WideMaterial &inside = (&wide[i])[wide[i].inside];
    EXPECT_EQ(&inside, &wide[i == 0 ? 3 : 4]);
    ASSERT_EQ(inside.count, 1u);
    EXPECT_EQ(inside.inside, 0u);
    EXPECT_EQ(wide[i].lobes[0].ior, 1.25f);
    EXPECT_EQ(inside.lobes[0].ior, 1.0f / 1.25f);
    // Single directions ask for no light.
    EXPECT_EQ(wide[i].smooth, i == 0);
    EXPECT_EQ(inside.smooth, i == 0);
  }
  ASSERT_EQ(wide[1].count, 1u);
  EXPECT_EQ(wide[1].inside + wide[1].smooth + wide[1].transmits, 0u);
}

TEST(WideMaterials, AllLayersFit) {
  PrincipledDescription p = glass(0.3f);
  for (Parameter PrincipledDescription::*share :
       {&PrincipledDescription::coat, &PrincipledDescription::metallic, &PrincipledDescription::transmission})
    p.*share = Parameter{glm::vec3(0.5f)};
  p.coat_tint = Parameter{glm::vec3(1.0f)};
  p.specular = Parameter{glm::vec3(0.5f)};
  const std::vector<Material> materials = {layered(p)};
  EXPECT_EQ(make_wide_materials(materials)[0].count, 5u);
}

} // namespace
} // namespace lancer
