// A whole surface in lanes: every lane answers with the bits that it gives alone, whatever its neighbours are.
#include "compile/ready_lobes.h"
#include "integrator/stages/lobe_means.h"
#include "lane_numbers.h"
#include "random_lobes.h"
#include "scene/material.h"

#include <gtest/gtest.h>

namespace lancer {
namespace {

using testing::all_codes;
using testing::Code;
using testing::Described;
using testing::described;
using testing::kMostLanes;
using testing::Lanes;
using testing::layers_of;
using testing::lobe_of;
using testing::near;
using testing::put_lanes;
using testing::Random;
using testing::Report;
using testing::unit;

// Where a lane looks from, what it asks for and which numbers it draws with.
constexpr int kAsked = 3, kDrawn = 4;
struct Place {
  glm::vec3 wo, ns, ng, wi[kAsked];
  glm::vec3 u[kDrawn]; // of the lobe, of the direction
  bool inside;
};

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

template <class F> Vec3<F> vector_of(const Place *of, const glm::vec3 Place::*member) {
  Vec3<F> v;
  put_lanes<F>(v, [&](int i) { return of[i].*member; });
  return v;
}

template <class F> void begin(Bsdf<F> &bsdf, const Place *of, bool bump_correction) {
  MaskOf<F> inside;
  put_lanes<F>(inside, [&](int i) { return of[i].inside; });
  bsdf.begin(vector_of<F>(of, &Place::wo), vector_of<F>(of, &Place::ns), vector_of<F>(of, &Place::ng), inside, bump_correction);
}

template <class F> void report_value(const char *name, const BsdfValue<F> &value, Report<F> &add) {
  for (const Vec3<F> &part : value.part)
    add(name, part);
  add(name, value.pdf);
}

// Everything that a surface answers.
template <class F> void report_all(Bsdf<F> &bsdf, const Place *of, Report<F> &add) {
  bsdf.complete();
  add("smooth", bsdf.smooth);
  add("transmits", bsdf.transmits);
  add("emission", bsdf.emission);
  add("albedo", bsdf.albedo());
  for (const Component component : {Component::Diffuse, Component::Glossy, Component::Transmission})
    add("shown", bsdf.shown(component));
  add("mean_normal", mean_normal(bsdf));
  const Mixture<F> mixture = mix(bsdf, Vec3<F>(F(0.0f)), true);
  add("mix: normal", mixture.normal);
  add("mix: diffuse", mixture.diffuse);
  add("mix: specular", mixture.specular);
  add("mix: matt", mixture.matt);
  for (int k = 0; k < kAsked; ++k) {
    Vec3<F> wi;
    put_lanes<F>(wi, [&](int i) { return of[i].wi[k]; });
    report_value("eval", bsdf.eval(wi), add);
    report_value("eval_lit", bsdf.eval_lit(wi), add);
  }
  for (int k = 0; k < kDrawn; ++k) {
    Vec3<F> u;
    put_lanes<F>(u, [&](int i) { return of[i].u[k]; });
    const BsdfSample<F> sample = bsdf.sample(u.x, u.y, u.z);
    add("sample: pdf", sample.pdf);
    add("sample: wi", sample.wi);
    add("sample: weight", sample.weight);
    add("sample: share", sample.share[0]);
    add("sample: share", sample.share[1]);
    add("sample: delta", sample.delta);
    add("sample: transmitted", sample.transmitted);
    add("sample: component", sample.component);
    add("sample: alpha2", sample.alpha2);
    report_value("eval of what was drawn", bsdf.eval(sample.wi), add);
    report_value("eval_lit of what was drawn", bsdf.eval_lit(sample.wi), add);
  }
}

// Samples of lanes alone that are not 0.
int count_samples(const std::vector<Report<float>> &alone) {
  int found = 0;
  for (const Report<float> &report : alone)
    for (const auto &entry : report.entries)
      found += std::string(entry.name) == "sample: pdf" && std::bit_cast<float>(entry.words[0]) > 0.0f;
  return found;
}

// compute(Lanes<F>(), first lane): a report. Returns how many samples were not 0.
template <class Compute> int expect_the_same(const Compute &compute, const std::string &what) {
  std::vector<Report<float>> alone;
  for (int i = 0; i < kMostLanes; ++i)
    alone.push_back(compute(Lanes<float>(), i));
  testing::expect_lanes_hold<Float<4>>(compute, alone, what);
  testing::expect_lanes_hold<Float<8>>(compute, alone, what);
  testing::expect_lanes_hold<Float<16>>(compute, alone, what);
  return count_samples(alone);
}

// Surfaces of lobes of these codes.
int expect_the_same(Random &random, const std::vector<Code> &codes, const std::string &what) {
  Place places[kMostLanes];
  std::vector<std::vector<Described>> lobes(codes.size());
  for (Place &at : places) {
    at = place(random);
    for (size_t k = 0; k < codes.size(); ++k)
      lobes[k].push_back(described(random, codes[k], at.ns));
  }
  const bool bump_correction = random.next() % 4;
  return expect_the_same(
      [&]<class F>(Lanes<F>, int first) {
        Report<F> report;
        Bsdf<F> bsdf;
        begin(bsdf, places + first, bump_correction);
        for (const std::vector<Described> &of : lobes)
          if (of[0].lobe.kind == LobeKind::Principled)
            add_principled(bsdf, lobe_of<F>(&of[size_t(first)]), layers_of<F>(&of[size_t(first)]));
          else
            add_lobe(bsdf, lobe_of<F>(&of[size_t(first)]));
        report_all(bsdf, places + first, report);
        return report;
      },
      what);
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
    EXPECT_GT(samples, 40 * kMostLanes * kDrawn / 8) << code.name();
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
ReadyLobe planned(Random &random, const Code &code) {
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
  const auto share = [&] { return Parameter{glm::vec3(0.1f + 0.8f * random.uniform())}; };
  auto p = std::make_shared<PrincipledDescription>();
  p->rules = code.rules;
  p->distribution = code.distribution;
  p->option = code.option;
  p->base_color = Parameter{from.layers.base_color};
  p->metallic = share();
  p->transmission = share();
  p->coat = share();
  p->roughness = Parameter{glm::vec3(from.layers.roughness)};
  p->coat_roughness = Parameter{glm::vec3(from.layers.coat_roughness)};
  p->ior = Parameter{glm::vec3(1.1f + random.uniform())};
  p->specular = Parameter{glm::vec3(from.layers.specular)};
  p->specular_tint = Parameter{from.layers.specular_tint};
  if (code.kind == LobeKind::Principled)
    lobe.principled = std::move(p);
  return make_ready_lobes(material)[0];
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
      Place places[kMostLanes];
      std::vector<ReadyLobe> ready;
      for (Place &at : places) {
        at = place(random);
        ready.push_back(planned(random, code));
      }
      for (const ReadyLobe &one : ready) {
        ASSERT_EQ(one.code(), ready[0].code());
        ASSERT_TRUE(one.has(PrincipledLayer::Gloss));
      }
      // Every third surface is of one material.
      const auto material_of = [&](int lane) { return &ready[k % 3 ? size_t(lane) : 0]; };
      samples += expect_the_same(
          [&]<class F>(Lanes<F>, int first) {
            LaneLobes<F> lanes;
            for (int i = 0; i < LanesOf<F>::kWidth; ++i) {
              lanes.of[i] = material_of(first + i);
              lanes.inside |= uint32_t(places[first + i].inside) << i;
              lanes.same = lanes.same && lanes.of[i] == lanes.of[0];
            }
            Report<F> report;
            Bsdf<F> bsdf;
            begin(bsdf, places + first, true);
            if (layered)
              add_principled(bsdf, lanes.principled_carrier(), lanes.principled(), lanes);
            else
              add_cached(bsdf, lanes.inputs(), lanes);
            report_all(bsdf, places + first, report);
            return report;
          },
          code.name() + ", draw " + std::to_string(k));
      if (HasFailure())
        return;
    }
    EXPECT_GT(samples, 40 * kMostLanes * kDrawn / 8) << code.name();
  }
}

} // namespace
} // namespace lancer
