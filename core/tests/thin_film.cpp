// Thin films: where they change nothing, where light does not interfere, and interference at one wavelength.
#include "bsdf/microfacet.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "statistics.h"

namespace lancer {
namespace {

constexpr float kAir = 1.0f;

Lobe<float> glass(float ior, Rules rules, float thickness, float film_ior) {
  Lobe<float> lobe = make_microfacet(Scatter::Both, 0, glm::vec3(1.0f), 0.1f, 0.1f, rules);
  set_schlick(lobe, glm::vec3(f0_of_ior(ior)), glm::vec3(1.0f), ior, glm::vec3(1.0f), glm::vec3(1.0f));
  if (thickness > 0.0f)
    set_film(lobe, thickness, film_ior);
  return lobe;
}

Lobe<float> gold(FresnelKind kind, float thickness, float film_ior) {
  Lobe<float> lobe = make_microfacet(Scatter::Reflect, 0, glm::vec3(1.0f), 0.1f, 0.1f, Rules::Blender50);
  if (kind == FresnelKind::F82)
    set_f82(lobe, glm::vec3(0.9f, 0.6f, 0.2f), glm::vec3(0.9f, 0.8f, 0.4f));
  else
    set_conductor(lobe, kind, {0.18f, 0.42f, 1.37f}, {3.42f, 2.35f, 1.77f});
  if (thickness > 0.0f)
    set_film(lobe, thickness, film_ior);
  return lobe;
}

void expect_equal(const Lobe<float> &covered, const Lobe<float> &bare, float tolerance, const char *what) {
  for (const float cosine : {1.0f, 0.8f, 0.5f, 0.2f, 0.03f}) {
    const FacetResponse<float> a = facet_response(covered, cosine), b = facet_response(bare, cosine);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(a.reflected[i], b.reflected[i], tolerance) << what << " from " << cosine;
      EXPECT_NEAR(a.through[i], b.through[i], tolerance) << what << " from " << cosine;
    }
    EXPECT_EQ(a.cos_t, b.cos_t);
  }
}

// A film of the index of one of its neighbours has one boundary; the other reflects nothing, so that nothing interferes.
TEST(ThinFilm, OfANeighboursIndexIsInvisible) {
  // Some twenty float roundings.
  constexpr float kRounding = 4e-6f;
  for (const Rules rules : {Rules::Blender45, Rules::Blender50})
    for (const float ior : {1.5f, 2.4f, 0.7f})
      for (const float thickness : {0.2f, 40.0f, 600.0f}) {
        expect_equal(glass(ior, rules, thickness, kAir), glass(ior, rules, 0.0f, 0.0f), kRounding, "of air");
        // A film that fades has an index of its own.
        if (thickness >= 30.0f)
          expect_equal(glass(ior, rules, thickness, ior), glass(ior, rules, 0.0f, 0.0f), kRounding, "of glass");
      }
  expect_equal(gold(FresnelKind::Conductor, 300.0f, kAir), gold(FresnelKind::Conductor, 0.0f, 0.0f), kRounding, "metal");
  // The index that stands for F82 has its values at two angles.
  const FacetResponse<float> covered = facet_response(gold(FresnelKind::F82, 300.0f, kAir), 1.0f),
                             bare = facet_response(gold(FresnelKind::F82, 0.0f, 0.0f), 1.0f);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(covered.reflected[i], bare.reflected[i], 1e-5f);
}

TEST(ThinFilm, ThinnerThanAnyIsNone) {
  for (const float thickness : {0.01f, 0.1f}) {
    expect_equal(glass(1.5f, Rules::Blender50, thickness, 1.33f), glass(1.5f, Rules::Blender50, 0.0f, 0.0f), 0.0f, "glass");
    expect_equal(gold(FresnelKind::F82, thickness, 1.33f), gold(FresnelKind::F82, 0.0f, 0.0f), 0.0f, "gold");
  }
}

double of_boundary(double cosine, double eta, bool s) {
  const double g = std::sqrt(eta * eta - 1.0 + cosine * cosine);
  const double r = s ? (cosine - g) / (cosine + g) : (eta * eta * cosine - g) / (eta * eta * cosine + g);
  return r * r;
}

// Light of a path difference beyond its coherence adds without interference: by the series of reflections in the film.
TEST(ThinFilm, TooThickReflectsWithoutColor) {
  const double film = 1.33, ior = 1.8;
  for (const Rules rules : {Rules::Blender45, Rules::Blender50})
    for (const float cosine : {1.0f, 0.6f, 0.2f}) {
      const double c = cosine, inside = std::sqrt(1.0 - (1.0 - c * c) / (film * film));
      double sum = 0.0;
      for (const bool s : {false, true}) {
        const double top = of_boundary(c, film, s), bottom = of_boundary(inside, ior / film, s);
        sum += 0.5 * (top + (1.0 - top) * (1.0 - top) * bottom / (1.0 - top * bottom));
      }
      // Scaled by f0 over the index's own, which is 1 here. The table ends where 0.2 % of the coherence is left.
      const FacetResponse<float> response = facet_response(glass(float(ior), rules, 1e9f, float(film)), cosine);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(response.reflected[i], sum, 4e-3 * sum) << int(rules) << " from " << cosine;
        EXPECT_NEAR(response.reflected[i] + response.through[i], 1.0f, 1e-6f);
      }
    }
}

// A quarter of a wavelength of the square root of an index cancels the reflection, and half a wavelength restores it. The eye's
// green is a band around 540 nm.
TEST(ThinFilm, AQuarterWaveCancelsGreen) {
  const float ior = 2.0f, root = std::sqrt(ior), quarter = 540.0f / (4.0f * root);
  for (const Rules rules : {Rules::Blender45, Rules::Blender50}) {
    const float bare = facet_response(glass(ior, rules, 0.0f, 0.0f), 1.0f).reflected.y;
    const float cancelled = facet_response(glass(ior, rules, quarter, root), 1.0f).reflected.y;
    const float restored = facet_response(glass(ior, rules, 2.0f * quarter, root), 1.0f).reflected.y;
    EXPECT_LT(cancelled, 0.06f * bare) << int(rules);
    EXPECT_NEAR(restored, bare, 0.12f * bare) << int(rules);
  }
}

// Light passes a film as easily from below as from above. As seen from within the glass, whose index scales that of the film,
// wavelengths are shorter by the index, so that the same film is thicker; Cycles leaves its thickness.
TEST(ThinFilm, ReflectsAlikeOnBothSides) {
  testing::Random random(3);
  for (int k = 0; k < 2000; ++k) {
    const Rules rules = k % 2 ? Rules::Blender45 : Rules::Blender50;
    const float ior = 1.1f + random.uniform(), film = 1.05f + random.uniform(), thickness = 31.0f + 1500.0f * random.uniform();
    const Lobe<float> above = glass(ior, rules, thickness, film), below = glass(1.0f / ior, rules, ior * thickness, film / ior);
    const float cosine = 0.05f + 0.95f * random.uniform();
    const FacetResponse<float> there = facet_response(above, cosine), back = facet_response(below, there.cos_t);
    // The path difference of some ten wavelengths has an error of 2^-22 of a turn each.
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(there.reflected[i], back.reflected[i], 3e-5f) << ior << " " << film << " " << thickness << " " << cosine;
  }
}

TEST(ThinFilm, ReflectsNoMoreThanItGetsAtAnyInput) {
  testing::Random random(9);
  const std::vector<float> thicknesses{0.11f, 1.0f, 29.0f, 500.0f, 1e9f, 1e30f}, indices{1e-5f, 0.7f, 1.0f, 1.33f, 4.0f, 1e30f};
  for (const float thickness : thicknesses)
    for (const float film : indices)
      for (const float cosine : {0.0f, 1e-4f, 0.3f, 1.0f}) {
        std::vector<Lobe<float>> lobes{gold(FresnelKind::Conductor, thickness, film), gold(FresnelKind::F82, thickness, film)};
        for (const Rules rules : {Rules::Blender45, Rules::Blender52})
          for (const float ior : {1e-5f, 0.6f, 1.0f, 1.5f, 1e10f})
            lobes.push_back(glass(ior, rules, thickness, film));
        for (const Lobe<float> &lobe : lobes) {
          const FacetResponse<float> response = facet_response(lobe, cosine);
          for (int i = 0; i < 3; ++i) {
            EXPECT_GE(response.reflected[i], 0.0f) << thickness << " " << film << " " << cosine;
            EXPECT_LE(response.reflected[i] + response.through[i], 1.0f + 1e-6f) << thickness << " " << film << " " << cosine;
          }
        }
      }
}

} // namespace
} // namespace lancer
