// Classes of materials that may be shaded in the same lanes.
#include "compile/features.h"

#include "compile/steps.h"
#include "lancer.h"

#include <gtest/gtest.h>

namespace lancer {
namespace {

Material of(const LobeDescription &lobe, uint32_t flags = 0) {
  Material material;
  material.lobes = {lobe};
  material.flags = flags;
  return material;
}
std::vector<uint32_t> classes_of(const std::vector<Material> &materials) {
  std::vector<MaterialView> views(materials.begin(), materials.end());
  std::vector<ReadyLobes> ready;
  for (MaterialView &view : views)
    view.ready = ready.emplace_back(make_ready_lobes(view)).lobes.data();
  return shading_classes(views);
}
LobeDescription glossy(float roughness, const glm::vec3 &color) {
  LobeDescription lobe;
  lobe.kind = LobeKind::Glossy;
  lobe.distribution = Facets::Ggx;
  lobe.roughness = Parameter{glm::vec3(roughness)};
  lobe.color = Parameter{color};
  return lobe;
}
template <class Change> LobeDescription changed(const Change &change) {
  LobeDescription lobe = glossy(0.3f, glm::vec3(0.5f));
  change(lobe);
  return lobe;
}

TEST(ShadingClasses, NumbersAloneMakeNoOther) {
  const std::vector<Material> materials = {of(glossy(0.3f, glm::vec3(0.5f))), of(glossy(0.7f, {0.1f, 0.0f, 0.9f})),
                                           of(glossy(0.0f, glm::vec3(0.0f)))};
  EXPECT_EQ(classes_of(materials), (std::vector<uint32_t>{0, 0, 0}));
}

TEST(ShadingClasses, OtherCodeDoes) {
  std::vector<Material> materials = {of(glossy(0.3f, glm::vec3(0.5f))),
                                     of(changed([](LobeDescription &lobe) { lobe.kind = LobeKind::Glass; })),
                                     of(changed([](LobeDescription &lobe) { lobe.rules = Rules::Blender3; })),
                                     of(changed([](LobeDescription &lobe) { lobe.distribution = Facets::Beckmann; })),
                                     of(changed([](LobeDescription &lobe) { lobe.option = 1; })),
                                     // Anisotropic facets are not planned in advance.
                                     of(changed([](LobeDescription &lobe) { lobe.anisotropy = Parameter{glm::vec3(0.5f)}; })),
                                     of(glossy(0.3f, glm::vec3(0.5f)), LANCER_MATERIAL_NO_BUMP_CORRECTION), Material{}};
  Material two = materials[0];
  two.lobes.push_back(two.lobes[0]);
  materials.push_back(two);
  const std::vector<uint32_t> classes = classes_of(materials);
  for (uint32_t i = 0; i < materials.size(); ++i)
    EXPECT_EQ(classes[i], i);
  // A second time: the numbers are those of the first.
  const std::vector<Material> first = materials;
  materials.insert(materials.end(), first.begin(), first.end());
  const std::vector<uint32_t> twice = classes_of(materials);
  for (uint32_t i = 0; i < twice.size(); ++i)
    EXPECT_EQ(twice[i], i % 9);
}

TEST(ShadingClasses, NodesHaveOneOfTheirOwn) {
  Material fed = of(glossy(0.3f, glm::vec3(0.5f)));
  fed.program.nodes.resize(1);
  EXPECT_EQ(classes_of({fed, fed, of(glossy(0.3f, glm::vec3(0.5f)))}), (std::vector<uint32_t>{0, 1, 2}));
}

// A Principled with one input that differs from the plain one.
TEST(ShadingClasses, EachPartOfPrincipledIsOne) {
  using P = PrincipledDescription;
  Parameter P::*const parts[] = {&P::coat,      &P::metallic,          &P::transmission, &P::sheen,
                                 &P::coat_tint, &P::diffuse_roughness, &P::emission,     &P::coat_normal};
  Parameter P::*const numbers[] = {&P::roughness, &P::ior, &P::specular, &P::specular_tint, &P::base_color};
  const auto with = [](Parameter P::*part, float value) {
    LobeDescription lobe;
    lobe.kind = LobeKind::Principled;
    P &p = lobe.principled.emplace();
    p.ior = Parameter{glm::vec3(1.5f)};
    p.specular = Parameter{glm::vec3(0.5f)};
    p.coat_tint = Parameter{glm::vec3(1.0f)};
    if (part)
      p.*part = Parameter{{value, 0.2f, 0.3f}};
    return of(lobe);
  };
  std::vector<Material> materials = {with(nullptr, 0.0f)};
  for (Parameter P::*part : parts)
    materials.push_back(with(part, 0.4f));
  for (Parameter P::*part : parts)
    materials.push_back(with(part, 0.7f));
  const std::vector<uint32_t> classes = classes_of(materials);
  constexpr uint32_t kParts = uint32_t(std::size(parts));
  for (uint32_t i = 0; i < classes.size(); ++i)
    EXPECT_EQ(classes[i], i <= kParts ? i : i - kParts);
  for (Parameter P::*number : numbers)
    EXPECT_EQ(classes_of({materials[0], with(number, 0.4f)}), (std::vector<uint32_t>{0, 0}));
}

} // namespace
} // namespace lancer
