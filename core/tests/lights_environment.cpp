// Environment sampling: the density integrates to one, samples follow it, and no pole, seam or bright texel is lost.
#include "compile/scene.h"
#include "lancer.h"
#include "lights/environment.h"
#include "nodes_lab.h"

#include <cstring>
#include <gtest/gtest.h>
#include <random>

namespace lancer {
namespace {

// Bright near both poles and at the seam, dark elsewhere.
std::vector<float> harsh_weights(uint32_t width, uint32_t height) {
  std::vector<float> weights(size_t(width) * height, 0.25f);
  for (uint32_t column = 0; column < width; ++column) {
    weights[column] = 20.0f;
    weights[size_t(height - 1) * width + column] = 10.0f + float(column);
  }
  for (uint32_t row = 0; row < height; ++row) {
    weights[size_t(row) * width] = 8.0f;
    weights[size_t(row) * width + width - 1] = 0.0f;
  }
  return weights;
}

TEST(DirectionMap, CoversTheSphereOnce) {
  for (const glm::uvec2 size : {glm::uvec2(8, 4), glm::uvec2(16, 7), glm::uvec2(1024, 512)}) {
    const uint32_t width = size.x, height = size.y;
    const DirectionMap map(width, height, std::vector<float>(size_t(width) * height, 1.0f));
    double total = 0.0;
    for (uint32_t row = 0; row < height; ++row)
      total += width * map.solid_angle(row);
    // Some thousand roundings of double.
    EXPECT_NEAR(total, 4.0 * glm::pi<double>(), 1e-12);
    // Differences of sums up to 1, which have up to 1024 roundings of 2^-53, relative to the share of a polar row, at least
    // 9.4e-6.
    const double even = 0.25 / glm::pi<double>();
    EXPECT_NEAR(map.pdf({0.0, 0.0, 1.0}), even, 1.3e-8 * even);
    EXPECT_NEAR(map.pdf({0.0, 0.0, -1.0}), even, 1.3e-8 * even);
  }
}

TEST(DirectionMap, SamplesHaveTheDensityThatPdfTells) {
  const DirectionMap map(16, 8, harsh_weights(16, 8));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0.0f, 0x1.fffffep-1f);
  for (int i = 0; i < 10000; ++i) {
    const DirectionMap::Sample sample = map.sample({uniform(random), uniform(random)});
    ASSERT_NEAR(glm::length(sample.direction), 1.0, 1e-15);
    ASSERT_GT(sample.pdf, 0.0);
    // At a cell's edge the direction may round into the neighbour: accept the density next to it, too.
    bool same = false;
    for (const double apart : {0.0, -1e-7, 1e-7})
      same |= map.pdf(glm::vec3(glm::normalize(sample.direction + glm::dvec3(apart, -apart, apart)))) == sample.pdf;
    EXPECT_TRUE(same);
  }
}

TEST(DirectionMap, ChiSquare) {
  // Counts in a finer grid of another shape, over the whole sphere: uniform solid angles in z and the angle about it.
  constexpr int kRows = 24, kColumns = 15, kCount = 200000, kFine = 100;
  const DirectionMap map(16, 8, harsh_weights(16, 8));
  std::vector<double> expected(kRows * kColumns), counts(kRows * kColumns);
  for (int row = 0; row < kRows * kFine; ++row) {
    for (int column = 0; column < kColumns * kFine; ++column) {
      const double z = 1.0 - 2.0 * (row + 0.5) / (kRows * kFine), r = std::sqrt(1.0 - z * z);
      const double phi = 2.0 * glm::pi<double>() * (column + 0.5) / (kColumns * kFine);
      expected[size_t(row / kFine * kColumns + column / kFine)] += kCount * map.pdf({r * std::cos(phi), r * std::sin(phi), z}) *
                                                                   4.0 * glm::pi<double>() /
                                                                   (double(kRows) * kFine * kColumns * kFine);
    }
  }
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(0.0f, 0x1.fffffep-1f);
  for (int i = 0; i < kCount; ++i) {
    const glm::dvec3 w = map.sample({uniform(random), uniform(random)}).direction;
    const double phi = std::atan2(w.y, w.x) / (2.0 * glm::pi<double>());
    const int row = std::min(int((1.0 - w.z) / 2.0 * kRows), kRows - 1);
    const int column = std::min(int((phi < 0.0 ? phi + 1.0 : phi) * kColumns), kColumns - 1);
    ++counts[size_t(row * kColumns + column)];
  }
  double total = 0.0, chi2 = 0.0;
  int used = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    total += expected[i];
    if (expected[i] < 5.0)
      continue;
    chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    ++used;
  }
  // The midpoint rule resolves the edges between the map's cells to 1/kFine of its own cells.
  EXPECT_NEAR(total / kCount, 1.0, 5e-3);
  // Mean used - 1, variance twice that; 6 standard deviations include the error of the midpoint rule.
  EXPECT_LT(chi2, used + 6.0 * std::sqrt(2.0 * used));
}

TEST(DirectionMap, NothingToChooseGivesNoSample) {
  const DirectionMap map(8, 4, std::vector<float>(32, 0.0f));
  EXPECT_EQ(map.sample({0.5f, 0.5f}).pdf, 0.0);
  EXPECT_EQ(map.pdf({0.0, 1.0, 0.0}), 0.0);
}

// A world whose radiance is one image, seen through a rotated mapping.
struct Sky {
  World world;
  Normalisation normalisation;

  // Grey texels; the environment projection of lancer.h.
  Sky(uint32_t width, uint32_t height, const std::vector<float> &texels, const glm::vec3 &rotation) {
    Image image;
    image.width = width;
    image.height = height;
    image.channels = 1;
    image.kind = TexelKind::Float;
    image.alpha = AlphaMode::None;
    image.keep(allocate_texels(texels.size() * sizeof(float)));
    std::memcpy(image.memory.get(), texels.data(), texels.size() * sizeof(float));
    lancer_test::hold(world.program, std::move(image));
    Node direction, mapping, environment;
    direction.kind = LANCER_NODE_COORDINATE;
    direction.option = LANCER_COORDINATE_GENERATED;
    mapping.kind = LANCER_NODE_MAPPING;
    mapping.inputs[0].node = 0;
    mapping.inputs[2].value = rotation;
    mapping.inputs[3].value = glm::vec3(1.0f);
    environment.kind = LANCER_NODE_ENVIRONMENT;
    environment.image_count = 1;
    environment.inputs[0].node = 1;
    world.program.nodes = {direction, mapping, environment};
    world.radiance.node = 2;
    world.schedule = world.program.schedule(std::span(&world.radiance, 1));
  }
  Environment environment() const { return Environment(world, normalisation, BuildContext{.threads = 2}, true); }
};

// Returns the integral of radiance over all directions, by this many samples of the environment.
double integral(const Environment &environment, size_t nodes, int count, bool transmits) {
  std::vector<glm::vec4> values(nodes);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0.0f, 0x1.fffffep-1f);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const LightSample sample = environment.sample({uniform(random), uniform(random)}, values, nullptr, transmits);
    EXPECT_GT(sample.pdf, 0.0);
    sum += double(sample.radiance.x) / sample.pdf;
  }
  return sum / count;
}

TEST(Environment, FindsOneBrightTexelUnderAnyMapping) {
  constexpr uint32_t width = 256, height = 128;
  for (const uint32_t where : {64u * width + 7u, 0u, 127u * width + 100u, 30u * width}) {
    std::vector<float> texels(size_t(width) * height, 1e-3f);
    texels[where] = 1e4f;
    for (const glm::vec3 &rotation : {glm::vec3(0.0f), glm::vec3(0.4f, 1.1f, -2.0f)}) {
      // A texel at the image's pole is a needle: rotated away from the map's own pole, a plain sum does not resolve it.
      if (rotation != glm::vec3(0.0f) && (where < width || where >= 127 * width))
        continue;
      const Sky sky(width, height, texels, rotation);
      const Environment environment = sky.environment();
      ASSERT_TRUE(environment.varies());
      // Rotation keeps the integral: compare with a plain sum over uniform directions, fine enough to resolve the texel.
      std::vector<glm::vec4> values(3);
      const DirectionMap even(2048, 1024, std::vector<float>(2048 * 1024, 1.0f));
      double want = 0.0;
      for (uint32_t row = 0; row < 1024; ++row)
        for (uint32_t column = 0; column < 2048; ++column)
          want +=
              double(
                  environment.radiance(even.direction(even.polar(row + 0.5), even.azimuth(column + 0.5)), values, nullptr).x) *
              even.solid_angle(row);
      // 8 x 8 midpoints per texel of a bilinear tent give it to 1 %; the samples, whose standard deviation is below the mean,
      // to 0.2 %.
      for (const bool transmits : {false, true})
        EXPECT_NEAR(integral(environment, 3, 200000, transmits) / want, 1.0, 0.01) << where;
      // The map's evaluations have equal weight in their cell: at a pole, where the lower ones represent more, this is 8 % off.
      // Rotated, an evaluation every half cell is one every 0.75 texels where the image's rows are short; a tent sampled like
      // this is off by at most 2 sinc^2(1 / 0.75) = 8.5 %, and by little along its other side, where several evaluations divide
      // a texel.
      EXPECT_NEAR(environment.mean() * 4.0 * glm::pi<double>() / want, 1.0, 0.15);
    }
  }
}

TEST(Environment, ShinesNowhereWithoutAChance) {
  std::vector<float> texels(64 * 32, 0.0f);
  texels[10 * 64 + 5] = 1.0f;
  const Sky sky(64, 32, texels, glm::vec3(0.3f));
  const Environment environment = sky.environment();
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 w = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    for (const bool transmits : {false, true})
      EXPECT_GT(environment.pdf(w, transmits), 0.04 * 0.25 / glm::pi<double>());
  }
}

TEST(Environment, SurfacesSampleWhatIsBrighterThanTheMean) {
  // Half of the sky 1, a quarter each 2 and 4: the mean is 2 in texels and nearly so in directions, as columns share them.
  std::vector<float> texels(64 * 32);
  for (size_t i = 0; i < texels.size(); ++i)
    texels[i] = i % 64 < 32 ? 1.0f : i % 64 < 48 ? 2.0f : 4.0f;
  const Sky sky(64, 32, texels, glm::vec3(0.0f));
  const Environment environment = sky.environment();
  const auto pdf = [&](int column, bool transmits) {
    const double phi = glm::pi<double>() * (1.0 - (column + 0.5) / 32.0);
    double sum = 0.0;
    for (const double side : {-1.0, 1.0})
      sum += 0.5 * environment.pdf({std::cos(side * phi), std::sin(side * phi), 0.0}, transmits);
    return sum;
  };
  std::vector<double> above, in_proportion;
  for (int column = 0; column < 32; ++column) {
    above.push_back(pdf(column, false));
    in_proportion.push_back(pdf(column, true));
  }
  std::sort(above.begin(), above.end());
  std::sort(in_proportion.begin(), in_proportion.end());
  EXPECT_GT(in_proportion.front(), 0.1 * in_proportion.back());
  // Directions darker than the mean have only the uniform share.
  EXPECT_LT(above.front(), 0.05 * above.back());
}

TEST(Environment, LooksAtEachTexelUpToABound) {
  const auto looks = [](uint32_t resolution, uint32_t widest) {
    const MapSize size = map_size(resolution, widest);
    // Without an image or a given resolution, making a map takes some seconds at most.
    EXPECT_LE(double(size.width) * size.height * size.looks * size.looks, 0x1p25);
    EXPECT_LE(size.width, 2048u);
    EXPECT_EQ(size.height, size.width / 2);
    return std::pair(size.width, size.looks);
  };
  EXPECT_EQ(looks(0, 0), std::pair(1024u, 2u));
  EXPECT_EQ(looks(0, 256), std::pair(256u, 2u));
  EXPECT_EQ(looks(512, 256), std::pair(512u, 2u));
  EXPECT_EQ(looks(7, 100), std::pair(8u, 13u));
  EXPECT_EQ(looks(0, 8192), std::pair(2048u, 4u));
  EXPECT_EQ(looks(0, 16384), std::pair(2048u, 4u));
  EXPECT_EQ(looks(65536, 0), std::pair(2048u, 4u));
  EXPECT_EQ(looks(1, 1u << 22), std::pair(4u, 2048u));
  EXPECT_EQ(looks(0, 1u << 22), std::pair(2048u, 4u));
}

TEST(Environment, CanBeCancelled) {
  const Sky sky(4, 2, std::vector<float>(8, 1.0f), glm::vec3(0.0f));
  std::atomic<bool> cancel{true};
  EXPECT_THROW(Environment(sky.world, sky.normalisation, BuildContext{.cancel = &cancel}, true), BuildCancelled);
}

TEST(Environment, AConstantOneIsNoLight) {
  World world;
  world.radiance.value = glm::vec3(0.25f, 0.5f, 0.75f);
  const Normalisation normalisation;
  const Environment environment(world, normalisation, BuildContext{}, true);
  EXPECT_FALSE(environment.varies());
  EXPECT_EQ(environment.radiance({0.0, 1.0, 0.0}, {}, nullptr), world.radiance.value);
  EXPECT_EQ(environment.sample({0.5f, 0.5f}, {}, nullptr, false).pdf, 0.0);
  EXPECT_EQ(environment.pdf({0.0, 1.0, 0.0}, false), 0.0);
}

} // namespace
} // namespace lancer
