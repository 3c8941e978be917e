// Lobes prepared once for a material equal those made at every hit.
#include "compile/steps.h"
#include "scene/material.h"

#include "bsdf/build.h"
#include "bsdf_seen.h"
#include "statistics.h"

#include <gtest/gtest.h>

namespace lancer {
namespace {

using testing::direction;
using testing::Random;

// All layers.
PrincipledDescription layered(Random &random) {
  PrincipledDescription p;
  const auto share = [&] { return Parameter{glm::vec3(0.2f + 0.6f * random.uniform())}; };
  for (Parameter PrincipledDescription::*input :
       {&PrincipledDescription::metallic, &PrincipledDescription::roughness, &PrincipledDescription::specular,
        &PrincipledDescription::anisotropic, &PrincipledDescription::transmission, &PrincipledDescription::coat,
        &PrincipledDescription::coat_roughness, &PrincipledDescription::sheen, &PrincipledDescription::sheen_roughness,
        &PrincipledDescription::diffuse_roughness})
    p.*input = share();
  for (Parameter PrincipledDescription::*color :
       {&PrincipledDescription::base_color, &PrincipledDescription::specular_tint, &PrincipledDescription::coat_tint,
        &PrincipledDescription::sheen_tint, &PrincipledDescription::emission})
    p.*color = Parameter{{random.uniform(), random.uniform(), random.uniform()}};
  p.ior = Parameter{glm::vec3(1.1f + random.uniform())};
  p.coat_ior = Parameter{glm::vec3(1.1f + random.uniform())};
  return p;
}

// A material of one layered lobe, some of whose inputs are results of a node.
struct Layered {
  Layered(const PrincipledDescription &principled, const Parameter &tangent) {
    LobeDescription &lobe = material.lobes.emplace_back();
    lobe.kind = LobeKind::Principled;
    lobe.principled = principled;
    lobe.tangent = tangent;
    material.program.nodes.resize(1);
    ready = make_ready_lobes(material);
  }

  // Returns f |cos| of the lobe as a shader makes it for this value of the node, or made completely in place.
  glm::vec3 value(const glm::vec4 &node, bool in_place, const glm::vec3 &wo, const glm::vec3 &wi) const {
    const LobeDescription &lobe = material.lobes[0];
    const LobeInputs<float> inputs = evaluate(lobe, std::span(&node, 1));
    const PrincipledInputs<float> principled = evaluate(*lobe.principled, std::span(&node, 1));
    const glm::vec3 n(0.0f, 0.0f, 1.0f);
    Bsdf<float> bsdf;
    bsdf.begin(wo, n, n, false, true);
    if (in_place)
      add_principled(bsdf, inputs, principled);
    else
      add_principled(bsdf, inputs, principled, LaneLobes<float>{{&ready[0]}});
    bsdf.complete();
    return bsdf.eval(wi).f() + bsdf.emission;
  }

  Material material;
  ReadyLobes ready;
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
      PrincipledDescription principled = layered(random);
      if (input)
        principled.*input = fed;
      // Without an input the tangent varies.
      const Layered layered(principled, input ? Parameter{glm::vec3(1.0f, 0.0f, 0.0f)} : fed);
      const glm::vec4 node(0.2f + random.uniform(), 0.3f, 0.4f, 1.0f);
      const glm::vec3 wo = direction(0.2 + 0.7 * random.uniform()), wi = direction(0.2 + 0.7 * random.uniform(), 3.0);
      const glm::vec3 ready = layered.value(node, false, wo, wi), in_place = layered.value(node, true, wo, wi);
      // Tables are interpolated in another order: a product of ten factors, each with a few roundings, times the factor 1 / (1
      // - albedo) of the layers above.
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(ready[c], in_place[c], 64.0f * 0x1p-24f * std::max(in_place[c], 1.0f)) << k;
    }
}

// A material of one microfacet lobe.
Material of_facets(LobeKind kind, Rules rules = Rules::Blender45, Facets facets = Facets::MultiGgx) {
  Material material;
  LobeDescription &lobe = material.lobes.emplace_back();
  lobe.kind = kind;
  lobe.rules = rules;
  lobe.distribution = facets;
  lobe.color = Parameter{{0.8f, 0.5f, 0.2f}};
  lobe.weight = Parameter{{0.7f, 0.9f, 1.0f}};
  lobe.roughness = Parameter{glm::vec3(0.4f)};
  lobe.ior = Parameter{glm::vec3(1.25f)};
  return material;
}

TEST(ReadyLobes, FacetsThatNothingChangesArePlanned) {
  const auto is_planned = [](const Material &material) { return make_ready_lobes(material)[0].has(PrincipledLayer::Gloss); };
  for (const LobeKind kind : {LobeKind::Glossy, LobeKind::Conductor, LobeKind::Glass})
    for (const Rules rules : {Rules::Blender4, Rules::Blender45}) {
      Material material = of_facets(kind, rules);
      EXPECT_TRUE(is_planned(material));
      // Lobes with varying inputs, or with a tangent, are made at the hit.
      material.program.nodes.resize(1);
      EXPECT_FALSE(is_planned(material));
      material.program.nodes.clear();
      material.lobes[0].anisotropy = Parameter{glm::vec3(0.5f)};
      EXPECT_EQ(is_planned(material), kind == LobeKind::Glass);
    }
  EXPECT_FALSE(is_planned(of_facets(LobeKind::Glossy, Rules::Blender3)));
  EXPECT_FALSE(is_planned(of_facets(LobeKind::Glossy, Rules::Blender45, Facets::AshikhminShirley)));
  for (const LobeKind kind : {LobeKind::Lambert, LobeKind::Diffuse, LobeKind::Refraction, LobeKind::Beckmann})
    EXPECT_FALSE(is_planned(of_facets(kind)));
}

TEST(ReadyLobes, PlannedFacetsAreThoseMadeInPlace) {
  Random random(7);
  for (const LobeKind kind : {LobeKind::Glossy, LobeKind::Conductor, LobeKind::Glass})
    for (const Facets facets : {Facets::Ggx, Facets::Beckmann, Facets::MultiGgx})
      for (const bool inside : {false, true}) {
        const ReadyLobes lobes = make_ready_lobes(of_facets(kind, Rules::Blender45, facets));
        const ReadyLobe &ready = lobes[0];
        const glm::vec3 wo = direction(0.2 + 0.7 * random.uniform()), wi = direction(0.7, 2.0), n(0.0f, 0.0f, 1.0f);
        Bsdf<float> planned, in_place;
        for (Bsdf<float> *bsdf : {&planned, &in_place}) {
          bsdf->begin(wo, n, n, inside, true);
          bsdf == &planned ? add_cached(*bsdf, ready.inputs, LaneLobes<float>{{&ready}, inside})
                           : add_lobe(*bsdf, ready.inputs);
          bsdf->complete();
        }
        // A single factor, interpolated along the cosine first or last.
        for (const glm::vec3 &w : {wi, -wi})
          for (int c = 0; c < 3; ++c) {
            const float a = planned.eval(w).f()[c], b = in_place.eval(w).f()[c];
            EXPECT_NEAR(a, b, 16.0f * 0x1p-24f * b);
          }
      }
}

// A Principled with these shares of its layers.
ReadyLobes of_layers(float coat, float metallic, float transmission, float ior = 1.25f) {
  Material material;
  LobeDescription &lobe = material.lobes.emplace_back();
  lobe.kind = LobeKind::Principled;
  PrincipledDescription &p = lobe.principled.emplace();
  p.coat = Parameter{glm::vec3(coat)};
  p.metallic = Parameter{glm::vec3(metallic)};
  p.transmission = Parameter{glm::vec3(transmission)};
  p.ior = Parameter{glm::vec3(ior)};
  p.specular = Parameter{glm::vec3(0.5f)};
  return make_ready_lobes(material);
}

TEST(ReadyLobes, LayersThatAreThereArePlannedForBothSides) {
  using L = PrincipledLayer;
  const ReadyLobes whole = of_layers(0.5f, 0.5f, 0.5f), bare = of_layers(0.0f, 0.0f, 0.0f, 1.0f);
  const ReadyLobe &all = whole[0], &none = bare[0];
  for (const L layer : {L::Coat, L::Metal, L::Glass, L::Gloss}) {
    EXPECT_TRUE(all.has(layer));
    EXPECT_TRUE(all.plan(layer, true));
    EXPECT_FALSE(none.has(layer));
  }
  for (const L layer : {L::Sheen, L::Emission, L::Diffuse})
    EXPECT_FALSE(all.has(layer));
  EXPECT_EQ(all.plan(L::Glass, false)->plan.lobe.ior, 1.25f);
  EXPECT_EQ(all.plan(L::Glass, true)->plan.lobe.ior, 1.0f / 1.25f);
}

} // namespace
} // namespace lancer
