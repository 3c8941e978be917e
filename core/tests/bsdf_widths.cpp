// A whole surface in lanes: every lane answers with the bits that it gives alone, whatever its neighbours are.
#include "compile/ready_lobes.h"
#include "integrator/stages/lobe_means.h"
#include "lane_numbers.h"
#include "principled_lab.h"
#include "scene/material.h"
#include "statistics.h"

#include <gtest/gtest.h>
#include <limits>

namespace lancer {
namespace {

using testing::kMostLanes;
using testing::Lanes;
using testing::put_lanes;
using testing::Random;
using testing::Report;

float one_of(Random &random, std::initializer_list<float> numbers) { return numbers.begin()[random.next() % numbers.size()]; }
glm::vec3 unit(Random &random) {
  const float z = 2.0f * random.uniform() - 1.0f, phi = 6.28f * random.uniform(), s = std::sqrt(1.0f - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}
glm::vec3 near(Random &random, const glm::vec3 &n, float apart) { return glm::normalize(n + apart * unit(random)); }
// Black in one of three.
glm::vec3 color(Random &random) {
  const uint64_t kind = random.next() % 6;
  const glm::vec3 any(random.uniform(), random.uniform(), 1.2f * random.uniform());
  return kind < 2 ? glm::vec3(0.0f) : kind < 3 ? glm::vec3(1.0f) : any;
}
float share(Random &random) { return random.next() % 3 ? random.uniform() : one_of(random, {0.0f, 1.0f, 0.5f}); }
float roughness(Random &random) {
  return random.next() % 2 ? random.uniform() : one_of(random, {0.0f, 1e-5f, 3e-3f, 0.06f, 0.3f, 1.0f});
}
float index(Random &random) {
  return random.next() % 2 ? 0.5f + 1.5f * random.uniform()
                           : one_of(random, {1.0f, 1.5f, 1.00001f, 0.7f, std::numeric_limits<float>::infinity()});
}

// What is the same in all lanes: one code.
struct Code {
  LobeKind kind;
  Rules rules;
  Facets distribution;
  uint32_t option;

  std::string name() const {
    return "kind " + std::to_string(int(kind)) + ", rules " + std::to_string(int(rules)) + ", facets " +
           std::to_string(int(distribution)) + ", option " + std::to_string(option);
  }
};

std::vector<Code> all_codes() {
  std::vector<Code> all;
  for (uint32_t number = 0; number < kLobeKinds; ++number)
    for (const Rules rules : testing::kAllRules)
      for (const Facets facets : {Facets::Ggx, Facets::Beckmann, Facets::AshikhminShirley, Facets::MultiGgx})
        for (const uint32_t option : {0u, 1u}) {
          const LobeKind kind = static_cast<LobeKind>(number);
          const bool of_facets = kind == LobeKind::Glossy || kind == LobeKind::Glass || kind == LobeKind::Refraction ||
                                 kind == LobeKind::Conductor;
          const bool layered = kind == LobeKind::Principled, cloth = kind == LobeKind::Sheen;
          const bool there = facets == Facets::Ggx || (facets == Facets::Beckmann && (of_facets || cloth)) ||
                             (facets == Facets::AshikhminShirley && kind == LobeKind::Glossy) ||
                             (facets == Facets::MultiGgx && (of_facets || layered));
          const bool optional = layered || kind == LobeKind::Diffuse || kind == LobeKind::Conductor;
          if (there && (optional || option == 0))
            all.push_back({kind, rules, facets, option});
        }
  return all;
}

// One lane's lobe.
struct Described {
  LobeInputs<float> lobe;
  PrincipledInputs<float> layers;
};

Described described(Random &random, const Code &code, const glm::vec3 &ns) {
  Described d;
  LobeInputs<float> &lobe = d.lobe;
  lobe.kind = code.kind;
  lobe.rules = code.rules;
  lobe.distribution = code.distribution;
  lobe.option = code.option;
  lobe.weight = random.next() % 8 ? glm::max(color(random), random.uniform()) : glm::vec3(0.0f);
  lobe.color = color(random);
  lobe.roughness = roughness(random);
  lobe.ior = index(random);
  lobe.shininess = random.uniform() * one_of(random, {0.0f, 1.0f, 4.0f, 200.0f, 1e5f});
  lobe.edge = color(random);
  lobe.anisotropy = one_of(random, {0.0f, 1.0f}) * (1.8f * random.uniform() - 0.9f);
  lobe.rotation = one_of(random, {0.0f, 1.0f}) * random.uniform();
  if (random.next() % 2)
    lobe.normal = near(random, ns, 0.8f);
  if (random.next() % 2)
    lobe.tangent = unit(random);
  PrincipledInputs<float> &in = d.layers;
  in.rules = code.rules;
  in.distribution = code.distribution;
  in.option = code.option;
  in.base_color = color(random);
  in.metallic = share(random);
  in.roughness = roughness(random);
  in.ior = 0.6f + random.uniform();
  in.diffuse_roughness = roughness(random);
  in.specular = random.next() % 2 ? 0.5f : random.uniform();
  in.specular_tint = random.next() % 2 ? glm::vec3(1.0f) : color(random);
  in.anisotropic = one_of(random, {0.0f, 1.0f}) * random.uniform();
  in.anisotropic_rotation = one_of(random, {0.0f, 1.0f}) * random.uniform();
  in.transmission = share(random);
  in.transmission_roughness = roughness(random);
  in.coat = share(random);
  in.coat_roughness = roughness(random);
  in.coat_ior = 1.0f + random.uniform();
  in.coat_tint = random.next() % 2 ? glm::vec3(1.0f) : color(random);
  if (random.next() % 2)
    in.coat_normal = near(random, ns, 0.8f);
  in.sheen = share(random);
  in.sheen_roughness = roughness(random);
  in.sheen_tint = color(random);
  in.emission = color(random);
  return d;
}

template <class F> LobeInputs<F> lobe_of(const Described *of) {
  LobeInputs<F> in;
  in.kind = of->lobe.kind;
  in.rules = of->lobe.rules;
  in.distribution = of->lobe.distribution;
  in.option = of->lobe.option;
#define LANCER_PUT(member) put_lanes<F>(in.member, [&](int i) { return of[i].lobe.member; })
  LANCER_PUT(weight);
  LANCER_PUT(color);
  LANCER_PUT(roughness);
  LANCER_PUT(ior);
  LANCER_PUT(shininess);
  LANCER_PUT(edge);
  LANCER_PUT(anisotropy);
  LANCER_PUT(rotation);
  LANCER_PUT(normal);
  LANCER_PUT(tangent);
#undef LANCER_PUT
  return in;
}

template <class F> PrincipledInputs<F> layers_of(const Described *of) {
  PrincipledInputs<F> in;
  in.rules = of->layers.rules;
  in.distribution = of->layers.distribution;
  in.option = of->layers.option;
#define LANCER_PUT(member) put_lanes<F>(in.member, [&](int i) { return of[i].layers.member; })
  LANCER_PUT(base_color);
  LANCER_PUT(metallic);
  LANCER_PUT(roughness);
  LANCER_PUT(ior);
  LANCER_PUT(diffuse_roughness);
  LANCER_PUT(specular);
  LANCER_PUT(specular_tint);
  LANCER_PUT(anisotropic);
  LANCER_PUT(anisotropic_rotation);
  LANCER_PUT(transmission);
  LANCER_PUT(transmission_roughness);
  LANCER_PUT(coat);
  LANCER_PUT(coat_roughness);
  LANCER_PUT(coat_ior);
  LANCER_PUT(coat_tint);
  LANCER_PUT(coat_normal);
  LANCER_PUT(sheen);
  LANCER_PUT(sheen_roughness);
  LANCER_PUT(sheen_tint);
  LANCER_PUT(emission);
#undef LANCER_PUT
  return in;
}

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
