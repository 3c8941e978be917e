// Laws by quadrature, at every roughness and height: no albedo exceeds 1, densities integrate to the samplers' probability, and
// light paths are reversible.
#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "bsdf/albedo_tables.h"
#include "bsdf/microfacet_eval.h"
#include "bsdf_catalogue.h"
#include "bsdf_facets.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::direction;
using testing::Known;
using testing::Random;

// Evaluates a microfacet lobe with its sampler's half vector, which float directions do not determine.
ColorValue<float> by_facet(const Lobe<float> &lobe, const glm::vec3 &wo, const glm::vec3 &wi, const glm::vec3 &h) {
  if (lobe.shape == LobeShape::Microfacet)
    return wi.z > 0.0f ? microfacet_eval_reflected(lobe, wo, wi, h) : microfacet_eval_through(lobe, wo, wi, h);
  const LobeValue<float> grey =
      lobe.shape == LobeShape::Beckmann ? coating_eval_pdf(lobe, wo, wi, h) : blinn_phong_eval_pdf(lobe, wo, h);
  return {glm::vec3(grey.f * wi.z), grey.pdf};
}

constexpr double kWide = 0.05;

struct Whole {
  double f = 0.0, pdf = 0.0; // integrals of the brightest channel of f cos, of green under a film, and of the density
};

// A pair of directions with its facet, and the solid angle of wi per area of the square.
struct Pair {
  glm::dvec3 wi{0.0}, h{0.0, 0.0, 1.0};
  double spanned = 0.0; // 0: no such pair
};

// Narrow lobes are parametrised by the slopes of their facets, wide ones by directions, whose horizon is an edge of the square.
Pair by_slopes(const glm::dvec3 &wo, const glm::dvec2 &place, double width, bool through, double eta) {
  double jacobian;
  Pair pair;
  pair.h = testing::half_vector_at(place, width, jacobian);
  const double cos_oh = glm::dot(wo, pair.h);
  if (!(cos_oh > 0.0))
    return {};
  if (!through) {
    pair.wi = 2.0 * cos_oh * pair.h - wo;
    pair.spanned = pair.wi.z > 0.0 ? jacobian * 4.0 * cos_oh : 0.0;
    return pair;
  }
  const double cos2_t = 1.0 - (1.0 - cos_oh * cos_oh) / (eta * eta);
  if (!(cos2_t > 0.0))
    return {};
  pair.wi = (cos_oh / eta - std::sqrt(cos2_t)) * pair.h - wo / eta;
  const double cos_ih = glm::dot(pair.wi, pair.h), sum = cos_oh + eta * cos_ih;
  pair.spanned = pair.wi.z < 0.0 ? jacobian * sum * sum / (eta * eta * -cos_ih) : 0.0;
  return pair;
}

Pair by_height(const glm::dvec3 &wo, const glm::dvec2 &place, bool through, double eta) {
  // The square root of the height spreads grazing directions.
  const double height = place.x * place.x, sine = std::sqrt((1.0 - height) * (1.0 + height));
  const double phi = 2.0 * std::numbers::pi * (place.y - 0.5);
  Pair pair;
  pair.wi = {sine * std::cos(phi), sine * std::sin(phi), through ? -height : height};
  pair.h = glm::normalize(through ? wo + eta * pair.wi : wo + pair.wi);
  if (pair.h.z < 0.0)
    pair.h = -pair.h;
  pair.spanned = 2.0 * std::numbers::pi * 2.0 * place.x;
  return pair;
}

// Integrates the light that facets send to one side. wo: in their frame.
Whole over_facets(const Lobe<float> &lobe, const glm::vec3 &wo, double width, bool through) {
  const auto integral = [&](const std::function<double(const ColorValue<float> &)> &part) {
    return testing::integrate_square(
        [&](const glm::dvec2 &place) {
          const Pair pair = width < kWide ? by_slopes(glm::dvec3(wo), place, width, through, double{lobe.ior})
                                          : by_height(glm::dvec3(wo), place, through, double{lobe.ior});
          return pair.spanned > 0.0 ? pair.spanned * part(by_facet(lobe, wo, glm::vec3(pair.wi), glm::vec3(pair.h))) : 0.0;
        },
        16, 4e-7, glm::dvec2(0.0), glm::dvec2(1.0),
        testing::slow() ? testing::Refinement{0x1p-20, 11} : testing::Refinement{0x1p-18, 9});
  };
  const double f = integral([&](const ColorValue<float> &value) {
    const glm::vec3 colored = lobe.color * value.f;
    // A film reflects one colour and lets others through: the sum of the brightest of both is no channel's.
    return double{lobe.film ? colored.y : std::max({colored.x, colored.y, colored.z})};
  });
  return {f, integral([](const ColorValue<float> &value) { return double{value.pdf}; })};
}

// Integrates over all directions; width: of a narrow lobe above the surface, 0: none.
Whole over_directions(const Bsdf<float> &bsdf, double width) {
  Whole whole;
  const testing::Domain above = width > 0.0 ? testing::half_vector_domain(bsdf.wo, width) : testing::direction_domain();
  for (const testing::Domain &domain : {above, testing::below_domain()}) {
    whole.f += testing::integrate_square(domain.density([&](const glm::vec3 &wi) {
      const glm::vec3 f = bsdf.eval(wi).f();
      return double{std::max({f.x, f.y, f.z})};
    }),
                                         16, 4e-7);
    whole.pdf +=
        testing::integrate_square(domain.density([&](const glm::vec3 &wi) { return double{bsdf.eval(wi).pdf}; }), 16, 4e-7);
  }
  return whole;
}

// Returns the probability that a lobe's sampler finds a direction: an integral over its numbers, split where the outcome
// changes. by_number(u): the outcome, and its share of paths.
struct Outcome {
  int kind = 0; // of the direction found; pieces of one kind are smooth
  double share = 0.0;
};
template <class Find> double found(const Find &find, int rows) {
  constexpr int kSteps = 64;
  constexpr std::array<double, 3> node{-0.7745966692414834, 0.0, 0.7745966692414834}, weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
  const auto at = [&](double x, double y) { return find(glm::vec2(glm::min(glm::dvec2(x, y), 1.0 - 0x1p-24))); };
  double sum = 0.0;
  for (int row = 0; row < rows; ++row) {
    const double y = (row + 0.5) / rows;
    const auto piece = [&](double low, double high) {
      for (int i = 0; i < 3; ++i)
        sum += 0.5 * (high - low) * weight[i] * at(0.5 * (low + high) + 0.5 * (high - low) * node[i], y).share / rows;
    };
    for (int step = 0; step < kSteps; ++step) {
      // Random numbers cluster at neither end: shorter pieces there resolve steep falloff.
      const auto place = [](double t) { return t * t * (3.0 - 2.0 * t); };
      double low = place(double(step) / kSteps), high = place((step + 1.0) / kSteps);
      const int kind = at(low, y).kind;
      if (kind != at(high, y).kind) {
        double before = low, after = high;
        for (int i = 0; i < 30; ++i) {
          const double middle = 0.5 * (before + after);
          (at(middle, y).kind == kind ? before : after) = middle;
        }
        piece(low, before);
        low = after;
      }
      piece(low, high);
    }
  }
  return sum;
}

double found_by_facets(const Lobe<float> &lobe, const glm::vec3 &wo, int rows) {
  const auto find = [&](const glm::vec2 &u) -> Outcome {
    if (lobe.shape != LobeShape::Microfacet) {
      const glm::vec3 h = lobe.shape == LobeShape::Beckmann ? beckmann_sample_visible(wo, lobe.alpha_x, lobe.alpha_x, u.x, u.y)
                                                            : sample_cosine_power(lobe.shininess, u.x, u.y);
      return reflect_about(wo, h).z > 0.0f ? Outcome{1, 1.0} : Outcome{};
    }
    const glm::vec3 h = lobe.beckmann ? beckmann_sample_visible(wo, lobe.alpha_x, lobe.alpha_y, u.x, u.y)
                                      : ggx_sample_visible(wo, lobe.alpha_x, lobe.alpha_y, u.x, u.y);
    const FacetResponse<float> response = facet_response(lobe, glm::dot(wo, h));
    const double mirrored = response.reflected_share();
    const bool above = reflect_about(wo, h).z > 0.0f;
    const bool below = refracts(lobe) && response.cos_t > 0.0f && testing::bent_about(wo, h, lobe.ior, response.cos_t).z < 0.0f;
    const bool total = refracts(lobe) && !(response.cos_t > 0.0f);
    return {above + 2 * below + 4 * total, (above ? mirrored : 0.0) + (below ? 1.0 - mirrored : 0.0)};
  };
  return found(find, rows);
}

// Returns the excess over 1 of the directional albedo, for lobes with tabulated energy: between nodes the table is linear where
// the curve is monotonic, so that the largest corner is a bound.
double table_excess(const Lobe<float> &lobe, double cosine) {
  if (lobe.energy == 1.0f)
    return 0.0;
  const float roughness = std::sqrt(std::sqrt(lobe.alpha_x * lobe.alpha_y)), c = static_cast<float>(cosine);
  const int nodes = refracts(lobe) ? tables::kCoarse : tables::kFine;
  const auto node = [&](float x, int up) {
    const float last = static_cast<float>(nodes - 1);
    return std::clamp((std::floor(x * last) + static_cast<float>(up)) / last, 0.0f, 1.0f);
  };
  float most = 0.0f;
  for (int corner = 0; corner < 8; ++corner) {
    const float r = node(roughness, corner & 1), z = node(c, corner >> 1 & 1),
                axis = node(tables::index_axis(lobe.ior), corner >> 2);
    // Invert the table's axis: the root of the reflectance at the normal is its square.
    const float bent = (1.0f + axis * axis) / (1.0f - axis * axis), ior = lobe.ior < 1.0f ? 1.0f / bent : bent;
    most = std::max(most, refracts(lobe) ? glass_albedo(r, z, ior) : ggx_albedo(r, z));
  }
  return most * lobe.energy - 1.0;
}

TEST(BsdfLaws, FacetsKeepTheirEnergyAndTheirProbability) {
  for (const double alpha : testing::slow() ? testing::roughnesses() : std::vector<double>{2e-5, 0.3})
    for (const Known &known : testing::facet_lobes(alpha))
      for (const double cosine : testing::heights()) {
        const Bsdf<float> bsdf = known.from(direction(cosine));
        ASSERT_EQ(bsdf.count, 1);
        const Lobe<float> &lobe = bsdf.lobes[0];
        if (lobe.delta)
          continue;
        const glm::vec3 &wo = bsdf.wo_local[lobe.frame];
        Whole whole = over_facets(lobe, wo, known.width, false);
        if (refracts(lobe) && !lobe.delta_through) {
          const Whole through = over_facets(lobe, wo, known.width, true);
          whole.f += through.f;
          whole.pdf += through.pdf;
        }
        EXPECT_LE(whole.f, 1.0 + 1e-5 + table_excess(lobe, cosine)) << known.name << " from " << cosine;
        // From the horizon, slivers of visible facets fall between the nodes, and where facets begin to reflect totally, a
        // square-root edge crosses both squares: there BsdfGrid compares the density facet by facet.
        if (lobe.delta_through || cosine < 0.1 || lobe.ior < 1.0f)
          continue;
        // The error of the rows, which decreases with their number, is about the difference to half and a quarter of them.
        const int rows = testing::slow() ? 2048 : 512;
        const double p = found_by_facets(lobe, wo, rows), half = found_by_facets(lobe, wo, rows / 2),
                     error = std::abs(p - half) + std::abs(half - found_by_facets(lobe, wo, rows / 4));
        EXPECT_NEAR(whole.pdf, p, 1e-5 + error) << known.name << " from " << cosine;
      }
}

TEST(BsdfLaws, NoOtherLobeGivesBackMoreThanItGets) {
  std::vector<Known> all;
  for (const double alpha : testing::slow() ? std::vector<double>{0.1, 0.3, 0.5, 0.7, 1.0} : std::vector<double>{0.1, 1.0}) {
    const std::string rough = ", alpha " + std::to_string(alpha);
    const auto add = [&](const char *name, LobeInputs<float> inputs) {
      inputs.color = glm::vec3(1.0f);
      all.push_back(testing::known(name + rough, {inputs}));
    };
    add("Phong", testing::described(LobeKind::Phong, 0.0f, 1.5f, testing::shininess_of(alpha)));
    add("Blinn-Phong", testing::described(LobeKind::BlinnPhong, 0.0f, 1.5f, testing::shininess_of(alpha)));
    add("Ashikhmin-Shirley", testing::at_alpha(LobeKind::Glossy, Facets::AshikhminShirley, alpha));
    add("sheen", testing::at_alpha(LobeKind::Sheen, Facets::Ggx, alpha));
    add("velvet", testing::at_alpha(LobeKind::Sheen, Facets::Beckmann, alpha));
    add("Oren-Nayar", testing::at_alpha(LobeKind::Diffuse, Facets::Ggx, alpha));
    for (const Rules rules : {Rules::Blender4, Rules::Blender45})
      for (const float metallic : {0.0f, 0.5f}) {
        PrincipledInputs<float> in = testing::plain(rules);
        in.distribution = Facets::Ggx;
        in.base_color = glm::vec3(1.0f);
        in.roughness = in.coat_roughness = in.sheen_roughness = float(std::sqrt(alpha));
        in.metallic = metallic;
        in.coat = in.sheen = 0.5f;
        all.push_back({"Principled " + std::to_string(int(rules)) + rough,
                       [in](Bsdf<float> &bsdf, const glm::vec3 &wo) { testing::look(bsdf, in, wo); }});
      }
  }
  // Narrow lobes, as far as half vectors of float directions resolve them: their error is 2^-24 over |wo + wi|.
  for (const double alpha : testing::slow() ? std::vector<double>{1e-3, 1e-2, 0.03} : std::vector<double>{1e-2})
    for (const LobeKind kind : {LobeKind::Phong, LobeKind::BlinnPhong})
      all.push_back(testing::known("shininess of alpha " + std::to_string(alpha),
                                   {testing::described(kind, 0.0f, 1.5f, testing::shininess_of(alpha))}, alpha));
  for (const Known &known : all)
    for (const double cosine : testing::heights()) {
      if (known.width > 0.0 && 0x1p-24 / (2.0 * cosine) > 1e-4 * known.width)
        continue;
      const Whole whole = over_directions(known.from(direction(cosine)), known.width);
      EXPECT_LE(whole.f, 1.0 + 1e-5) << known.name << " from " << cosine;
      EXPECT_LE(whole.pdf, 1.0 + 1e-5) << known.name << " from " << cosine;
    }
}

// Returns the effect of a rounded cosine, once from either side, on a lobe's reflectance or transmittance: 2^-22 of a sum of
// three products each.
double conditioned(const Lobe<float> &lobe, float cosine, bool through) {
  constexpr float kStep = 1e-4f;
  const auto response = [&](float c) {
    const FacetResponse<float> r = facet_response(lobe, c);
    return double{through ? r.through.x : r.reflected.x};
  };
  if (lobe.shape != LobeShape::Microfacet)
    return 0.0;
  const double at = response(cosine), above = std::abs(response(cosine + kStep) - at),
               below = std::abs(response(cosine - kStep) - at), slope = std::max(above, below) / double{kStep};
  return at > 0.0 ? 2.0 * 0x1p-22 * slope / at : 0.0;
}

// Evaluates both directions with the same facet, which excludes its rounding for narrow lobes. Near total reflection, where
// Fresnel's curve is steep, the rounding of a cosine matters.
TEST(BsdfLaws, LightGoesBothWaysAlike) {
  Random random(11);
  for (const double alpha : {2e-5, 1e-3, 0.1, 0.5, 1.0})
    for (const Known &known : testing::facet_lobes(alpha)) {
      if (!known.reciprocal)
        continue;
      for (int k = 0; k < 200; ++k) {
        const glm::vec3 wo = direction(0.1 + 0.9 * random.uniform(), 7.0 * random.uniform());
        const float x = random.uniform(), y = random.uniform();
        const Bsdf<float> bsdf = known.from(wo);
        const Lobe<float> &lobe = bsdf.lobes[0];
        if (lobe.delta)
          continue;
        const glm::vec3 wo_l = bsdf.wo_local[lobe.frame];
        const glm::vec3 h = ggx_sample_visible(wo_l, lobe.alpha_x, lobe.alpha_y, x, y);
        const float cos_oh = glm::dot(wo_l, h);
        if (const glm::vec3 wi = reflect_about(wo_l, h); wi.z > 0.1f && cos_oh > 0.1f && reflects(lobe)) {
          const Bsdf<float> other = known.from(bsdf.frames[lobe.frame].to_world(wi));
          const double there = by_facet(lobe, wo_l, wi, h).f.x / wi.z,
                       back = by_facet(other.lobes[0], wi, wo_l, h).f.x / wo_l.z;
          EXPECT_NEAR(there, back, (4e-6 + conditioned(lobe, cos_oh, false)) * there + 1e-30) << known.name;
        }
        if (!refracts(lobe) || lobe.delta_through)
          continue;
        const FacetResponse<float> response = facet_response(lobe, cos_oh);
        const glm::vec3 wi = testing::bent_about(wo_l, h, lobe.ior, response.cos_t);
        if (!(response.cos_t > 0.1f && wi.z < -0.1f && cos_oh > 0.1f))
          continue;
        // From the other side the same facet has the opposite normal; the axes flip with the side.
        const Bsdf<float> other = known.from(bsdf.frames[lobe.frame].to_world(wi));
        const Lobe<float> &under = other.lobes[0];
        const glm::vec3 h_under = -other.frames[under.frame].to_local(bsdf.frames[lobe.frame].to_world(h));
        const glm::vec3 to = other.frames[under.frame].to_local(bsdf.frames[lobe.frame].to_world(wo_l));
        const double there = by_facet(lobe, wo_l, wi, h).f.x / -wi.z;
        const double back = by_facet(under, other.wo_local[under.frame], to, h_under).f.x / wo_l.z;
        const double eta2 = double{lobe.ior} * lobe.ior;
        const double steep =
            conditioned(lobe, cos_oh, true) + conditioned(under, glm::dot(other.wo_local[under.frame], h_under), true);
        EXPECT_NEAR(there, eta2 * back, (4e-6 + steep) * there + 1e-30) << known.name;
      }
    }
}

} // namespace
} // namespace lancer
