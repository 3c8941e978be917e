// What is made once of a material's lobes is what would be made at every surface.
#include "scene/material.h"

#include "bsdf/build.h"
#include "bsdf_seen.h"
#include "statistics.h"

#include <gtest/gtest.h>

namespace lancer {
namespace {

using testing::direction;
using testing::Random;

// Every layer is there.
std::shared_ptr<PrincipledDescription> layered(Random &random) {
  auto p = std::make_shared<PrincipledDescription>();
  const auto share = [&] { return Parameter{glm::vec3(0.2f + 0.6f * random.uniform())}; };
  for (Parameter PrincipledDescription::*input :
       {&PrincipledDescription::metallic, &PrincipledDescription::roughness, &PrincipledDescription::specular,
        &PrincipledDescription::anisotropic, &PrincipledDescription::transmission, &PrincipledDescription::coat,
        &PrincipledDescription::coat_roughness, &PrincipledDescription::sheen, &PrincipledDescription::sheen_roughness,
        &PrincipledDescription::diffuse_roughness})
    (*p).*input = share();
  for (Parameter PrincipledDescription::*color :
       {&PrincipledDescription::base_color, &PrincipledDescription::specular_tint, &PrincipledDescription::coat_tint,
        &PrincipledDescription::sheen_tint, &PrincipledDescription::emission})
    (*p).*color = Parameter{{random.uniform(), random.uniform(), random.uniform()}};
  p->ior = Parameter{glm::vec3(1.1f + random.uniform())};
  p->coat_ior = Parameter{glm::vec3(1.1f + random.uniform())};
  return p;
}

// A material of one layered lobe, some of whose inputs a node gives.
struct Layered {
  Layered(std::shared_ptr<const PrincipledDescription> principled, const Parameter &tangent) {
    LobeDescription &lobe = material.lobes.emplace_back();
    lobe.kind = LobeKind::Principled;
    lobe.principled = std::move(principled);
    lobe.tangent = tangent;
    material.program.nodes.resize(1);
    material.ready = make_ready_lobes(material);
  }

  // f |cos|, as a shader makes the lobe with that value of the node, or all of it in place.
  glm::vec3 value(const glm::vec4 &node, bool in_place, const glm::vec3 &wo, const glm::vec3 &wi) const {
    const LobeDescription &lobe = material.lobes[0];
    const LobeInputs inputs = evaluate(lobe, std::span(&node, 1));
    const PrincipledInputs principled = evaluate(*lobe.principled, std::span(&node, 1));
    const glm::vec3 n(0.0f, 0.0f, 1.0f);
    Bsdf bsdf;
    bsdf.begin(wo, n, n, false, true);
    if (in_place)
      add_principled(bsdf, inputs, principled);
    else
      add_layers(bsdf, inputs, principled, material.ready[0].layers.value());
    bsdf.complete();
    return bsdf.eval(wi).f() + bsdf.emission;
  }

  Material material;
};

TEST(ReadyLobes, WhatANodeVariesIsMadeInPlace) {
  using P = PrincipledDescription;
  Parameter P::*const inputs[] = {&P::base_color,
                                  &P::metallic,
                                  &P::roughness,
                                  &P::ior,
                                  &P::specular,
                                  &P::specular_tint,
                                  &P::anisotropic,
                                  &P::anisotropic_rotation,
                                  &P::transmission,
                                  &P::coat,
                                  &P::coat_roughness,
                                  &P::coat_ior,
                                  &P::coat_tint,
                                  &P::coat_normal,
                                  &P::sheen,
                                  &P::sheen_roughness,
                                  &P::sheen_tint,
                                  &P::emission,
                                  &P::diffuse_roughness,
                                  nullptr};
  Random random(5);
  Parameter fed;
  fed.node = 0;
  for (int k = 0; k < 50; ++k)
    for (Parameter P::*input : inputs) {
      const auto principled = layered(random);
      if (input)
        (*principled).*input = fed;
      // Without an input the tangent is what varies.
      const Layered layered(principled, input ? Parameter{glm::vec3(1.0f, 0.0f, 0.0f)} : fed);
      const glm::vec4 node(0.2f + random.uniform(), 0.3f, 0.4f, 1.0f);
      const glm::vec3 wo = direction(0.2 + 0.7 * random.uniform()), wi = direction(0.2 + 0.7 * random.uniform(), 3.0);
      const glm::vec3 ready = layered.value(node, false, wo, wi), in_place = layered.value(node, true, wo, wi);
      // Tables are read in another order: a product of ten factors, each off by a few roundings, times what 1 / (1 - albedo)
      // of the layers above enlarges them by.
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(ready[c], in_place[c], 64.0f * 0x1p-24f * std::max(in_place[c], 1.0f)) << k;
    }
}

// Seen about a normal that leans: lobes that reflect may be bent, so that none of them is made before.
TEST(ReadyLobes, OfFlatSurfacesOnlyWhereTheyMayBeBent) {
  for (const LobeKind kind : {LobeKind::Lambert, LobeKind::Mirror, LobeKind::Phong, LobeKind::BlinnPhong})
    for (const Rules rules : {Rules::Blender3, Rules::Blender45}) {
      Material material;
      LobeDescription &lobe = material.lobes.emplace_back();
      lobe.kind = kind;
      lobe.rules = rules;
      lobe.color = lobe.shininess = Parameter{glm::vec3(0.5f)};
      const ReadyLobe ready = make_ready_lobes(material)[0];
      ASSERT_TRUE(ready.whole);
      EXPECT_EQ(ready.flat_only, kind != LobeKind::Lambert || rules == Rules::Blender3);
      // The same as in place about the surface's own normal.
      const glm::vec3 wo = direction(0.4), wi = direction(0.7, 2.0), n(0.0f, 0.0f, 1.0f);
      Bsdf once, in_place;
      for (Bsdf *bsdf : {&once, &in_place}) {
        bsdf->begin(wo, n, n, false, true);
        bsdf == &once ? add(*bsdf, ready.lobe) : add_lobe(*bsdf, ready.inputs);
        bsdf->complete();
      }
      EXPECT_EQ(once.eval(wi).f(), in_place.eval(wi).f());
      EXPECT_EQ(once.albedo(), in_place.albedo());
    }
}

} // namespace
} // namespace lancer
