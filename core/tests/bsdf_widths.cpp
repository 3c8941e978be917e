// A whole surface in lanes: every lane answers with the bits that it gives alone, whatever its neighbours are.
#include "compile/steps.h"
#include "random_lobes.h"
#include "scene/material.h"
#include "widths/bsdf_kernel.h"
#include "widths/each_kernel.h"

#include <gtest/gtest.h>

namespace lancer {
namespace {

using testing::all_codes;
using testing::Code;
using testing::Described;
using testing::described;
using testing::near;
using testing::Place;
using testing::Random;
using testing::unit;

constexpr int kLanes = BsdfRows::kLanes;

Place place(Random &random) {
  Place at;
  at.ng = unit(random);
  at.ns = random.next() % 3 ? near(random, at.ng, 0.6f) : at.ng;
  at.wo = unit(random);
  if (glm::dot(at.wo, at.ng) < 0.0f)
    at.wo = -at.wo;
  at.wi[0] = unit(random);
  at.wi[1] = near(random, 2.0f * glm::dot(at.wo, at.ns) * at.ns - at.wo, 0.1f);
  at.wi[2] = near(random, -at.wo, 0.3f);
  for (glm::vec3 &u : at.u)
    u = {random.uniform(), random.uniform(), random.uniform()};
  at.inside = random.next() % 2;
  return at;
}

// Samples of lanes alone that are not 0.
int count_samples(const BsdfRows &alone) {
  int found = 0;
  for (int k = 0; k < alone.count; ++k)
    for (int i = 0; i < kLanes && std::string(alone.rows[k].name) == "sample: pdf"; ++i)
      found += std::bit_cast<float>(alone.rows[k].words[i]) > 0.0f;
  return found;
}

// run(kernel, rows) computes the rows of sixteen lanes. Returns how many samples were not 0.
template <class Run> int expect_the_same(const Run &run, const std::string &surface) {
  static BsdfRows alone, lanes;
  for (const BsdfKernel *kernel : LANCER_EACH_KERNEL(bsdf_kernel)) {
    const bool first = kernel == LANCER_EACH_KERNEL(bsdf_kernel)[0];
    BsdfRows &rows = first ? alone : lanes;
    run(*kernel, rows);
    EXPECT_LE(rows.count, BsdfRows::kMost);
    EXPECT_EQ(rows.count, alone.count);
    for (int k = 0; k < rows.count && !first; ++k)
      for (int i = 0; i < kLanes; ++i)
        if (rows.rows[k].words[i] != alone.rows[k].words[i]) {
          ADD_FAILURE() << surface << "; " << rows.rows[k].name << ": lane " << i << " of " << kernel->name << " has "
                        << std::bit_cast<float>(rows.rows[k].words[i]) << ", alone "
                        << std::bit_cast<float>(alone.rows[k].words[i]);
          return 0;
        }
  }
  return count_samples(alone);
}

// Surfaces of lobes of these codes.
int expect_the_same(Random &random, const std::vector<Code> &codes, const std::string &surface) {
  Place places[kLanes];
  std::vector<std::vector<Described>> lobes(codes.size());
  for (Place &at : places) {
    at = place(random);
    for (size_t k = 0; k < codes.size(); ++k)
      lobes[k].push_back(described(random, codes[k], at.ns));
  }
  const bool bump_correction = random.next() % 4;
  std::vector<const Described *> of;
  for (const std::vector<Described> &lobe : lobes)
    of.push_back(lobe.data());
  return expect_the_same([&](const BsdfKernel &kernel,
                             BsdfRows &rows) { kernel.described(places, of.data(), int(of.size()), bump_correction, rows); },
                         surface);
}

TEST(BsdfWidths, EveryLobe) {
  Random random(51);
  for (const Code &code : all_codes()) {
    int samples = 0;
    for (int k = 0; k < 40; ++k) {
      samples += expect_the_same(random, {code}, code.name() + ", draw " + std::to_string(k));
      if (HasFailure())
        return;
    }
    // An eighth of the samples at least: a third of the colours are black, and some lobes are dark from behind.
    EXPECT_GT(samples, 40 * kLanes * Place::kDraws / 8) << code.name();
  }
}

TEST(BsdfWidths, SeveralLobes) {
  Random random(52);
  const std::vector<Code> all = all_codes();
  for (int k = 0; k < 4000; ++k) {
    const auto any = [&] { return all[random.next() % all.size()]; };
    std::vector<Code> codes = {any(), any()};
    if (k % 2)
      codes.push_back(any());
    std::string what = "draw " + std::to_string(k);
    for (const Code &code : codes)
      what += "; " + code.name();
    expect_the_same(random, codes, what);
    if (HasFailure())
      return;
  }
}

// Materials whose facets are planned ahead.
// covered: they have a film.
ReadyLobes planned(Random &random, const Code &code, bool covered) {
  const Described from = described(random, code, {0.0f, 0.0f, 1.0f});
  Material material;
  LobeDescription &lobe = material.lobes.emplace_back();
  lobe.kind = code.kind;
  lobe.rules = code.rules;
  lobe.distribution = code.distribution;
  lobe.option = code.option;
  lobe.weight = Parameter{from.lobe.weight};
  lobe.color = Parameter{from.lobe.color};
  lobe.roughness = Parameter{glm::vec3(from.lobe.roughness)};
  lobe.ior = Parameter{glm::vec3(from.lobe.ior)};
  lobe.edge = Parameter{from.lobe.edge};
  const glm::vec3 film(covered ? 1.0f + 1000.0f * random.uniform() : 0.0f);
  lobe.film_thickness = Parameter{film};
  lobe.film_ior = Parameter{glm::vec3(from.lobe.film_ior)};
  const auto share = [&] { return Parameter{glm::vec3(0.1f + 0.8f * random.uniform())}; };
  PrincipledDescription p;
  p.rules = code.rules;
  p.distribution = code.distribution;
  p.option = code.option;
  p.base_color = Parameter{from.layers.base_color};
  p.metallic = share();
  p.transmission = share();
  p.coat = share();
  p.roughness = Parameter{glm::vec3(from.layers.roughness)};
  p.coat_roughness = Parameter{glm::vec3(from.layers.coat_roughness)};
  p.ior = Parameter{glm::vec3(1.1f + random.uniform())};
  p.specular = Parameter{glm::vec3(from.layers.specular)};
  p.specular_tint = Parameter{from.layers.specular_tint};
  p.film_thickness = Parameter{film};
  p.film_ior = Parameter{glm::vec3(from.layers.film_ior)};
  if (code.kind == LobeKind::Principled)
    lobe.principled = p;
  return make_ready_lobes(material);
}

TEST(BsdfWidths, LobesThatArePlanned) {
  Random random(53);
  for (const Code &code : all_codes()) {
    const bool layered = code.kind == LobeKind::Principled;
    if (code.rules == Rules::Blender3 || code.distribution == Facets::AshikhminShirley ||
        !(layered || code.kind == LobeKind::Glossy || code.kind == LobeKind::Glass || code.kind == LobeKind::Conductor))
      continue;
    int samples = 0;
    for (int k = 0; k < 40; ++k) {
      Place places[kLanes];
      std::vector<ReadyLobes> ready;
      for (Place &at : places) {
        at = place(random);
        ready.push_back(planned(random, code, k % 2 != 0));
      }
      for (const ReadyLobes &one : ready) {
        ASSERT_EQ(one[0].code(), ready[0][0].code());
        ASSERT_TRUE(one[0].has(PrincipledLayer::Gloss));
      }
      // Every third surface is of one material.
      const ReadyLobe *of[kLanes];
      for (int i = 0; i < kLanes; ++i)
        of[i] = &ready[k % 3 ? size_t(i) : 0][0];
      samples += expect_the_same([&](const BsdfKernel &kernel, BsdfRows &rows) { kernel.planned(places, of, layered, rows); },
                                 code.name() + ", draw " + std::to_string(k));
      if (HasFailure())
        return;
    }
    EXPECT_GT(samples, 40 * kLanes * Place::kDraws / 8) << code.name();
  }
}

} // namespace
} // namespace lancer
