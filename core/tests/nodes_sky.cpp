// The node SKY: its models against their definitions, and what is no table.
#include "nodes/air.h"
#include "nodes/sky_table.h"
#include "nodes_lab.h"
#include "scene/surface.h"
#include "widths/each_kernel.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// A table as the only image.
struct SkyStage : Stage {
  SkyStage(const std::vector<float> &texels, uint32_t width, uint32_t height) {
    add_image(description, image_of(texels, width, height, 3));
  }

  glm::vec3 in(const glm::vec3 &direction, uint32_t model, const std::vector<float> &matrix) {
    lancer_node sky = node(LANCER_NODE_SKY, model, {constant(direction.x, direction.y, direction.z)});
    std::copy(matrix.begin(), matrix.end(), sky.matrix);
    return glm::vec3(value({sky}));
  }
};

const std::vector<float> kNoSun = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0};
const std::vector<float> kIdentity = {1, 0, 0, 0, 1, 0, 0, 0, 1};

glm::vec3 direction(double elevation, double azimuth) {
  return glm::vec3(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
}

TEST(NodesSky, LooksUpByAzimuthFromTheSunAndElevation) {
  // The column is in x, the row in y.
  constexpr uint32_t width = 64, height = 32;
  std::vector<float> texels;
  for (uint32_t i = 0; i < width * height; ++i)
    texels.insert(texels.end(), {(float(i % width) + 0.5f) / width, (float(i / width) + 0.5f) / height, 1.0f});
  SkyStage stage(texels, width, height);
  for (const double sun : {0.0, 1.0, -2.5})
    for (const double elevation : {-1.2, -0.3, 0.2, 0.9})
      for (const double beside : {-2.9, -1.0, 0.5, 3.0}) {
        std::vector<float> matrix = kNoSun;
        matrix[6] = float(std::cos(sun)), matrix[7] = float(std::sin(sun)), matrix[8] = 0.0f;
        const glm::vec3 d = direction(elevation, sun + beside);
        // Columns go round clockwise from the azimuth opposite the sun. A texel's middle is exact up to roundings of 1.
        const glm::vec3 got = stage.in(d, LANCER_SKY_SINGLE_SCATTERING, matrix);
        EXPECT_NEAR(got.x, 0.5 - beside / (2.0 * M_PI), 2e-6);
        EXPECT_NEAR(got.y, 0.5 + std::copysign(0.5 * std::sqrt(std::abs(elevation) / (0.5 * M_PI)), elevation), 2e-6);
        const glm::vec3 old = stage.in(d, LANCER_SKY_NISHITA, matrix);
        const double fade = std::pow(std::max(1.0 + 2.5 * std::min(double(d.z), 0.0), 0.0), 3.0);
        EXPECT_NEAR(old.x, fade * (0.5 - beside / (2.0 * M_PI)), 2e-6);
        if (elevation > 0.0) {
          EXPECT_NEAR(old.y, std::sqrt(elevation / (0.5 * M_PI)), 2e-6);
        }
      }
}

TEST(NodesSky, DiscOfTheSun) {
  SkyStage stage(std::vector<float>(12, 0.5f), 2, 2);
  constexpr double half = 0.02;
  std::vector<float> matrix = {10, 0, 0, 30, 0, 0, 0, 0, 0, float(2.0 * half), 0.0f, 0};
  const auto sun_at = [&](double elevation) {
    const glm::vec3 sun = direction(elevation, 0.7);
    std::copy_n(&sun.x, 3, matrix.begin() + 6);
  };
  sun_at(0.4);
  for (const double away : {0.0, 0.5, 0.9, -0.9, 1.1}) {
    const glm::vec3 d = direction(0.4 + away * half, 0.7);
    const double limb = std::abs(away) < 1.0 ? 0.4 + 0.6 * std::sqrt(1.0 - away * away) : 0.0;
    const double disc = limb * (20.0 + 10.0 * away);
    // Limb darkening has the slope 0.6 r / sqrt(1 - r^2) below 1.3; a float has an error of 6e-8 / half in r.
    EXPECT_NEAR(stage.in(d, LANCER_SKY_MULTIPLE_SCATTERING, matrix).x, 0.5 + disc, 3e-4) << away;
    EXPECT_NEAR(stage.in(d, LANCER_SKY_NISHITA, matrix).x, limb > 0.0 ? disc : 0.5, 3e-4) << away;
  }
  // The ground hides what is below the horizon of the model.
  sun_at(0.005);
  matrix[10] = -0.004f;
  EXPECT_GT(stage.in(direction(-0.003, 0.7), LANCER_SKY_MULTIPLE_SCATTERING, matrix).x, 1.0f);
  EXPECT_NEAR(stage.in(direction(-0.005, 0.7), LANCER_SKY_MULTIPLE_SCATTERING, matrix).x, 0.5f, 1e-6f);
  EXPECT_LT(stage.in(direction(-0.001, 0.7), LANCER_SKY_NISHITA, matrix).x, 0.5f);
  // Nishita's lower rim is at the horizon then.
  const double limb = 0.4 + 0.6 * std::sqrt(1.0 - std::pow(0.005 / half, 2));
  EXPECT_NEAR(stage.in(direction(1e-7, 0.7), LANCER_SKY_NISHITA, matrix).x, 10.0 * limb, 1e-2);
  matrix[9] = 0.0f;
  EXPECT_NEAR(stage.in(direction(0.005, 0.7), LANCER_SKY_MULTIPLE_SCATTERING, matrix).x, 0.5f, 1e-6f);
}

TEST(NodesSky, AnalyticModels) {
  std::vector<float> table(33);
  const glm::vec3 sun = direction(0.6, -1.0);
  std::copy_n(&sun.x, 3, table.begin());
  for (size_t i = 3; i < table.size(); ++i)
    table[i] = 0.1f + 0.07f * float(i * 5 % 11);
  SkyStage stage(table, 11, 1);
  for (const double elevation : {-0.4, 0.0, 0.3, 1.5}) {
    const glm::vec3 d = direction(elevation, 0.4);
    const double cosine = double(glm::dot(d, sun)), gamma = std::acos(cosine), up = std::max(double(d.z), std::sin(0.001));
    const auto c = [&](size_t k, size_t channel) { return double(table[3 * (2 + k) + channel]); };
    glm::dvec3 perez, hosek;
    for (size_t k = 0; k < 3; ++k) {
      perez[int(k)] = double(table[3 + k]) * (1.0 + c(0, k) * std::exp(c(1, k) / up)) *
                      (1.0 + c(2, k) * std::exp(c(3, k) * gamma) + c(4, k) * cosine * cosine);
      const double glow = (1.0 + cosine * cosine) / std::pow(1.0 + c(8, k) * c(8, k) - 2.0 * c(8, k) * cosine, 1.5);
      hosek[int(k)] = double(table[3 + k]) * (1.0 + c(0, k) * std::exp(c(1, k) / (up + 0.01))) *
                      (c(2, k) + c(3, k) * std::exp(c(4, k) * gamma) + c(5, k) * cosine * cosine + c(6, k) * glow +
                       c(7, k) * std::sqrt(up));
    }
    const glm::vec3 analytic = stage.in(d, LANCER_SKY_HOSEK_WILKIE, kIdentity);
    for (int k = 0; k < 3; ++k)
      // Some tens of roundings of float.
      EXPECT_NEAR(double(analytic[k]), hosek[k] * 2.0 * M_PI / 683.0, 3e-6 * hosek[k]);
    if (elevation <= 0.0)
      continue; // exp(1 / 0.001) is beyond the range of float
    const glm::vec3 day = stage.in(d, LANCER_SKY_PREETHAM, kIdentity);
    EXPECT_NEAR(double(day.y) / perez.z, 1.0, 1e-5);
    EXPECT_NEAR(double(day.x) / (perez.x / perez.y * perez.z), 1.0, 1e-5);
    const double z = (1.0 - perez.x - perez.y) / perez.y * perez.z;
    EXPECT_NEAR(double(day.z), std::max(z, 0.0), 1e-5 * std::abs(z));
  }
}

TEST(NodesSky, RefusesWhatIsNoTable) {
  const auto refused = [](SkyStage &&stage, uint32_t model) {
    lancer_node sky = node(LANCER_NODE_SKY, model);
    try {
      read_program(stage.description.images, "test", &sky, 1);
    } catch (const std::exception &error) {
      return std::string(error.what()) == "test: node 0: image 0 is not a table of the sky";
    }
    return false;
  };
  EXPECT_FALSE(refused(SkyStage(std::vector<float>(33), 11, 1), LANCER_SKY_PREETHAM));
  EXPECT_TRUE(refused(SkyStage(std::vector<float>(30), 10, 1), LANCER_SKY_PREETHAM));
  EXPECT_TRUE(refused(SkyStage(std::vector<float>(66), 11, 2), LANCER_SKY_HOSEK_WILKIE));
  EXPECT_FALSE(refused(SkyStage(std::vector<float>(6), 1, 2), LANCER_SKY_NISHITA));
}

// Tables have the same bits in the lanes of each instruction set.
TEST(NodesSky, TablesOfEachKernel) {
  AzimuthCosines cosines;
  std::vector<float> rows[2] = {std::vector<float>(3 * kSkyHalf), std::vector<float>(3 * kSkyHalf)};
  for (uint32_t i = 0; i < kSkyHalf; ++i)
    cosines.of[i] = -std::cos(float(i) * 0.0122f);
  SingleRow single{};
  single.ray = {0.2f, 0.7f, -3e4f, &cosines};
  single.step = 5e3f;
  single.sun_is_low = true;
  for (int i = 0; i < SingleRow::kSteps; ++i) {
    single.at[i] = {5e3f * float(i), 1e10f + 1e9f * float(i)};
    for (int k = 0; k < 3; ++k)
      single.density[i][k] = 0.9f, single.depth[i][k] = 100.0f * float(i);
  }
  std::fill_n(single.densities, 3, 1.0f);
  const float densities[3] = {1.0f, 2.0f, 0.5f};
  std::vector<ClearRow> clear(4);
  MultipleRow multiple{};
  multiple.ray = {0.1f, 0.8f, 900.0f, &cosines};
  multiple.clear = clear.data();
  for (int i = 0; i < MultipleRow::kSteps; ++i) {
    multiple.t[i] = float(i), multiple.per_radius[i] = 1.0f / 6400.0f, multiple.high[i] = 1, multiple.part[i] = 0.3f;
    for (int k = 0; k < 4; ++k)
      multiple.of_ground[i][k] = 0.01f, multiple.air[i][k] = 0.02f, multiple.aerosols[i][k] = 0.03f;
  }
  one_lane::sky_kernel.clear_row(densities, 0.5f, clear[0]);
  one_lane::sky_kernel.clear_row(densities, 30.0f, clear[1]);
  for (const SkyKernel *kernel : LANCER_EACH_KERNEL(sky_kernel)) {
    SCOPED_TRACE(kernel->name);
    kernel->clear_row(densities, 0.5f, clear[2]);
    kernel->clear_row(densities, 30.0f, clear[3]);
    EXPECT_EQ(std::memcmp(&clear[0], &clear[2], 2 * sizeof(ClearRow)), 0);
    one_lane::sky_kernel.single_row(single, rows[0].data());
    kernel->single_row(single, rows[1].data());
    EXPECT_EQ(rows[0], rows[1]);
    EXPECT_GT(rows[0][0], 0.0f);
    one_lane::sky_kernel.multiple_row(multiple, rows[0].data());
    kernel->multiple_row(multiple, rows[1].data());
    EXPECT_EQ(rows[0], rows[1]);
    EXPECT_GT(rows[0][0], 0.0f);
  }
}

} // namespace
} // namespace lancer_test
