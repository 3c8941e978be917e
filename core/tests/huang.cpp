// Huang's fibre: the light of a clear fibre, samples that bring its value, and the ends of its inputs.
#include "bsdf/huang_sample.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::direction;
using testing::Random;

// A fibre along x, seen from wo, which has no z.
Lobe<float> fibre_of(float alpha, float aspect, float absorption, const glm::vec3 &parts, Rules rules, float ior = 1.55f,
                     float tilt = 0.1f) {
  return make_huang(glm::vec3(1.0f), alpha, aspect, ior, tilt, glm::vec3(absorption), parts, {0.0f, 1.0f, 0.0f}, rules);
}
glm::vec3 above(float sine) { return {sine, std::sqrt((1.0f - sine) * (1.0f + sine)), 0.0f}; }

// Directions by the sine of their angle along the fibre and the turn about it: their solid angle is the area of this square.
constexpr int kSide = 6;
constexpr size_t kCells = kSide * kSide;
glm::vec3 at_place(double x, double y) {
  const double sine = 2.0 * x - 1.0, cosine = std::sqrt((1.0 - sine) * (1.0 + sine)), phi = 2.0 * std::numbers::pi * y;
  return glm::vec3(glm::dvec3(sine, cosine * std::cos(phi), cosine * std::sin(phi)));
}
size_t cell_of(const glm::vec3 &w) {
  const double turn = std::atan2(double{w.z}, double{w.y}) / (2.0 * std::numbers::pi);
  const auto index = [](double at) { return std::min(size_t(std::max(at, 0.0) * kSide), size_t{kSide - 1}); };
  return index(0.5 * (double{w.x} + 1.0)) * kSide + index(turn < 0.0 ? turn + 1.0 : turn);
}

// Sums over samples, by cell.
struct Cells {
  std::array<double, kCells> sum{}, squares{};
  void add(size_t cell, double value) {
    sum[cell] += value;
    squares[cell] += value * value;
  }
  // The standard error of the sum of count samples.
  double spread(size_t cell, double count) const {
    return std::sqrt(std::max(squares[cell] - sum[cell] * sum[cell] / count, 0.0));
  }
};

// A chord from a place ends on the ellipse, where its length along the direction leads: on the way in, and on the way back.
TEST(Huang, ChordsEndOnTheEllipse) {
  Random random(9);
  for (const float aspect : {1.0f, 0.6f, 1e-3f, 1.7f})
    for (int k = 0; k < 100; ++k) {
      const Lobe<float> lobe = fibre_of(0.3f, aspect, 0.3f, glm::vec3(1.0f), Rules::Blender50);
      const float angle = 6.28f * random.uniform(), x = 1.8f * random.uniform() - 0.9f, turn = 6.28f * random.uniform();
      const float across = std::sqrt((1.0f - x) * (1.0f + x));
      const FibrePlace<float> place = fibre_place(lobe, std::sin(angle), std::cos(angle), 0.1f);
      glm::vec3 w(x, across * std::cos(turn), across * std::sin(turn));
      if (glm::dot(w, place.normal) > 0.0f)
        w = -w;
      const glm::vec3 from(0.0f, aspect * place.cosine, place.sine);
      for (const glm::vec3 &along : {w, -w}) {
        const Chord<float> way = chord(lobe, place, along);
        const glm::vec3 end = from + way.length * w, expected(0.0f, -aspect * way.cosine, -way.sine);
        EXPECT_NEAR(end.y, expected.y, 2e-5f) << aspect << " " << k;
        EXPECT_NEAR(end.z, expected.z, 2e-5f) << aspect << " " << k;
        EXPECT_NEAR(way.sine * way.sine + way.cosine * way.cosine, 1.0f, 1e-5f);
      }
    }
}

// Scales turn light out of the fibre's plane across, and tables give back what facets on a plane lose, which is 5 % of alpha
// too much on a curved surface.
TEST(Huang, AClearFibreReturnsAllLight) {
  constexpr int kDraws = 40000;
  uint64_t seed = 1;
  for (const float alpha : {0.001f, 0.1f, 0.3f, 0.6f})
    for (const float aspect : {1.0f, 0.6f})
      for (const float sine : {0.0f, 0.4f}) {
        const Lobe<float> lobe = fibre_of(alpha, aspect, 0.0f, glm::vec3(1.0f), Rules::Blender50, 1.55f, 0.035f);
        Random random(seed++);
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < kDraws; ++i) {
          const float part = random.uniform(), u = random.uniform(), v = random.uniform();
          const FibreSample<float> sample = huang_sample(lobe, above(sine), part, u, v, 7u);
          const double value = sample.valid ? double{sample.value.x} : 0.0;
          sum += value;
          squares += value * value;
        }
        const double mean = sum / kDraws, error = std::sqrt((squares / kDraws - mean * mean) / kDraws);
        EXPECT_NEAR(mean, 1.0, 0.05 * double{alpha} + 4.0 * error) << alpha << " " << aspect << " " << sine;
      }
}

// Each part alone, with an absorption that leaves nothing of the further reflections, which Cycles weighs differently in values
// and in samples, as it does the tilt of scales in R. By the rules of 4.x the nodes are even in the angle, where the integrand
// is smooth. A cell's error is the sum of both standard errors, five of which no cell of 648 exceeds by chance; 2e-4 of the
// light is that of 12 samples, too few for a normal distribution.
TEST(Huang, SamplesBringTheValue) {
  struct Part {
    const char *name;
    glm::vec3 factors;
    float absorption, tilt;
  };
  constexpr int kDraws = 60000, kFine = 12, kKeys = 4, kPlaces = kSide * kFine;
  constexpr double kEach = 4.0 * std::numbers::pi / (double{kPlaces} * kPlaces * kKeys), kCount = kFine * kFine * kKeys;
  uint64_t seed = 1;
  for (const Part &part : {Part{"R", {1.0f, 0.0f, 0.0f}, 10.0f, 0.0f}, Part{"TT", {0.0f, 1.0f, 0.0f}, 1.0f, 0.1f},
                           Part{"TRT", {0.0f, 0.0f, 1.0f}, 1.0f, 0.1f}})
    for (const float aspect : {1.0f, 0.7f, 1.5f})
      for (const float sine : {0.0f, -0.4f}) {
        const Lobe<float> lobe = fibre_of(0.3f, aspect, part.absorption, part.factors, Rules::Blender4, 1.55f, part.tilt);
        const glm::vec3 wo = above(sine);
        Cells drawn, valued;
        Random random(seed++);
        double all = 0.0;
        for (int i = 0; i < kDraws; ++i) {
          const float u_part = random.uniform(), u = random.uniform(), v = random.uniform();
          const FibreSample<float> sample = huang_sample(lobe, wo, u_part, u, v, 7u);
          if (!sample.valid)
            continue;
          drawn.add(cell_of(sample.wi), double{sample.value.x});
          all += double{sample.value.x} / kDraws;
        }
        for (int i = 0; i < kPlaces; ++i)
          for (int j = 0; j < kPlaces; ++j)
            for (uint32_t key = 0; key < kKeys; ++key) {
              const double x = (i + double{random.uniform()}) / kPlaces, y = (j + double{random.uniform()}) / kPlaces;
              valued.add(size_t(i / kFine * kSide + j / kFine), double{huang_eval(lobe, wo, at_place(x, y), key).f.x});
            }
        for (size_t cell = 0; cell < kCells; ++cell)
          EXPECT_NEAR(drawn.sum[cell] / kDraws, valued.sum[cell] * kEach,
                      5.0 * (drawn.spread(cell, kDraws) / kDraws + valued.spread(cell, kCount) * kEach) + 2e-4 * all)
              << part.name << " " << aspect << " " << sine << ", cell " << cell;
      }
}

// A value is an estimate by the numbers of its key, and the key and the directions alone decide it.
TEST(Huang, AKeyDecidesTheValue) {
  const Lobe<float> lobe = fibre_of(0.3f, 0.8f, 0.3f, glm::vec3(1.0f), Rules::Blender50);
  const glm::vec3 wo = above(0.2f), wi = glm::normalize(glm::vec3(0.1f, -0.8f, 0.3f));
  EXPECT_EQ(huang_eval(lobe, wo, wi, 3u).f.x, huang_eval(lobe, wo, wi, 3u).f.x);
  EXPECT_NE(huang_eval(lobe, wo, wi, 3u).f.x, huang_eval(lobe, wo, wi, 4u).f.x);
}

LobeInputs<float> described() {
  LobeInputs<float> inputs = testing::described(LobeKind::HairFibre, 0.3f, 1.55f, 0.0f, glm::vec3(0.2f));
  inputs.rules = Rules::Blender50;
  inputs.option = 1;
  inputs.roughness_across = 0.85f;
  inputs.tangent = glm::vec3(1.0f, 0.0f, 0.0f);
  return inputs;
}

// As in Cycles, a sample's density is 1, and the choice between lobes goes by their colours.
TEST(Huang, SamplesBesideAnotherLobeHaveTheDensityOfCycles) {
  LobeInputs<float> matt = testing::described(LobeKind::Lambert, 0.0f, 1.5f, 0.0f, glm::vec3(0.25f));
  const Bsdf<float> bsdf = testing::seen({described(), matt}, direction(0.6));
  ASSERT_EQ(bsdf.count, 2);
  EXPECT_NEAR(bsdf.lobes[0].probability, 0.8f, 1e-6f);
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const float part = random.uniform(), u = random.uniform(), v = random.uniform();
    const BsdfSample<float> sample = bsdf.sample(part, u, v);
    const float cosine = std::max(sample.wi.z, 0.0f);
    if (sample.pdf > 0.0f && part < 0.8f) {
      EXPECT_NEAR(sample.pdf, 0.8f + 0.2f * cosine * kInvPi, 1e-5f) << i;
      EXPECT_FALSE(sample.transmitted) << i;
    }
  }
}

// An index of 1 sends light straight on, in the plane of the tangent and wo, which fibres cross as any other. Facets of the
// least alpha hide a millionth of the light.
TEST(Huang, AFibreWithoutBoundariesLetsAllLightPass) {
  LobeInputs<float> inputs = described();
  inputs.ior = 1.0f;
  inputs.roughness = 0.0f;
  inputs.color = glm::vec3(0.0f);
  const glm::vec3 wo = direction(0.6);
  const Bsdf<float> bsdf = testing::seen({inputs}, wo);
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const float part = random.uniform(), u = random.uniform(), v = random.uniform();
    const BsdfSample<float> sample = bsdf.sample(part, u, v);
    EXPECT_NEAR(sample.weight.x, 1.0f, 1e-4f) << i;
    EXPECT_NEAR(glm::dot(sample.wi, wo), -1.0f, 1e-5f) << i;
  }
}

TEST(Huang, IsFiniteAtTheEndsOfItsInputs) {
  Random random(7);
  const glm::vec3 places[] = {{1.0f, 0.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}, above(0.0f), above(-0.999f)};
  const glm::vec3 others[] = {{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, {0.0f, -1.0f, 0.0f}, above(0.0f), {0.0f, 0.0f, 1.0f}};
  for (const Rules rules : {Rules::Blender4, Rules::Blender50})
    for (const float alpha : {0.0f, 1.0f})
      for (const float aspect : {0.0f, 1e-3f, 1.0f, 1e3f})
        for (const float ior : {1e-5f, 1.0f, 1.55f, 1e10f})
          for (const float absorption : {0.0f, 1e30f})
            for (const float tilt : {0.0f, 1.5f}) {
              const Lobe<float> lobe = fibre_of(alpha, aspect, absorption, glm::vec3(1.0f), rules, ior, tilt);
              const std::string what = std::to_string(alpha) + " " + std::to_string(aspect) + " " + std::to_string(ior) + " " +
                                       std::to_string(absorption) + " " + std::to_string(tilt);
              for (const glm::vec3 &wo : places) {
                const float albedo = huang_albedo(lobe, wo).x;
                EXPECT_TRUE(albedo >= 0.0f && albedo <= 1.0f) << what << " " << albedo;
                // The smoothest fibre has thousands of nodes.
                for (size_t k = 0; k < (alpha > 0.0f ? std::size(others) : 1); ++k) {
                  const float value = huang_eval(lobe, wo, others[k], 3u).f.x;
                  EXPECT_TRUE(value >= 0.0f && value < 1e30f) << what << " " << value;
                }
                for (int i = 0; i < 4; ++i) {
                  const float part = random.uniform(), u = i == 0 ? 0.0f : random.uniform(), v = random.uniform();
                  const FibreSample<float> sample = huang_sample(lobe, wo, part, u, v, 3u);
                  if (!sample.valid)
                    continue;
                  EXPECT_NEAR(glm::length(sample.wi), 1.0f, 1e-4f) << what;
                  EXPECT_TRUE(sample.value.x >= 0.0f && sample.value.x < 1e6f) << what << " " << sample.value.x;
                }
              }
            }
}

} // namespace
} // namespace lancer
