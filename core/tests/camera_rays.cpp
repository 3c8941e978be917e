// Camera rays from kernels in lanes equal those of the general code: Sampler, PixelFilter, Camera.
#include "integrator/stages/camera.h"
#include "lancer.h"

#include "camera_lab.h"

#include <gtest/gtest.h>

namespace {

using namespace lancer;

struct Started {
  uint32_t slot, pixel, sample;
  Ray ray;
};

std::vector<Started> start(const Camera &camera, const IntegratorSettings &settings,
                           const std::vector<SampleAddress> &addresses, std::vector<SampleResult> &results) {
  std::vector<Started> started;
  started.reserve(addresses.size());
  static const Motion still;
  CameraStage(camera, still, settings).start(addresses, false, results, [&](uint32_t slot, const Sampler &sampler) -> Ray & {
    return started.emplace_back(Started{slot, sampler.pixel(), sampler.sample(), {}}).ray;
  });
  return started;
}

// Pixels of a region, in an order that puts several samples into one block; the last block is not full.
std::vector<SampleAddress> places() {
  std::vector<SampleAddress> addresses;
  for (uint32_t i = 0; i < 16 * 40 + 5; ++i)
    addresses.push_back({i * 37 % 96, i * 23 % 64, i / 7});
  return addresses;
}

// Every ray must equal, bit for bit, the ray of its address.
void expect_general(Camera camera, IntegratorSettings settings) {
  camera.x = 70000;
  camera.y = 21;
  camera.width = 100000;
  camera.to_world =
      Affine::from_rows(std::array<double, 12>{0.36, 0.48, -0.8, 3.0, -0.8, 0.6, 0.0, -1.0 / 3.0, 0.48, 0.64, 0.6, 1e3}.data());
  const std::vector<SampleAddress> addresses = places();
  std::vector<SampleResult> results(addresses.size());
  for (SampleResult &result : results)
    result.radiance = glm::vec3(7.0f);
  const std::vector<Started> started = start(camera, settings, addresses, results);
  const PixelFilter filter(settings.filter(), settings.filter_width);
  const bool middle = settings.kind() != IntegratorKind::Path && settings.samples == 1;
  size_t next = 0;
  for (uint32_t slot = 0; slot < addresses.size(); ++slot) {
    EXPECT_EQ(results[slot].radiance, glm::vec3(0.0f));
    EXPECT_EQ(results[slot].alpha, 1.0f);
    const uint32_t x = camera.x + addresses[slot].x, y = camera.y + addresses[slot].y;
    const Sampler sampler(settings.seed, x, y, addresses[slot].sample);
    glm::dvec2 raster(x + 0.5, y + 0.5), lens(0.0);
    if (!middle) {
      raster += glm::dvec2(filter.sample(sampler.get1(kDimensionPixel)), filter.sample(sampler.get1(kDimensionPixel + 1)));
      if (camera.lens_radius > 0.0)
        lens = camera.aperture({sampler.get1(kDimensionLens), sampler.get1(kDimensionLens + 1)});
    }
    const Ray expected = camera.ray(raster, lens);
    if (expected.tmax < 0.0)
      continue;
    ASSERT_LT(next, started.size());
    const Started &found = started[next++];
    EXPECT_EQ(found.slot, slot);
    EXPECT_EQ(found.pixel, sampler.pixel());
    EXPECT_EQ(found.sample, sampler.sample());
    EXPECT_EQ(found.ray.o, expected.o);
    EXPECT_EQ(found.ray.d, expected.d);
    EXPECT_EQ(found.ray.tmin, expected.tmin);
    EXPECT_EQ(found.ray.tmax, expected.tmax);
    EXPECT_EQ(found.ray.kinds, uint32_t{LANCER_RAY_CAMERA});
  }
  EXPECT_EQ(next, started.size());
}

TEST(CameraRays, PinholesOfBothFilters) {
  for (const FilterKind filter : {FilterKind::Box, FilterKind::BlackmanHarris})
    expect_general(lancer_test::camera(CameraKind::Perspective, {}),
                   {.seed = 5, .pixel_filter = static_cast<uint32_t>(filter), .filter_width = 1.7f});
}

TEST(CameraRays, ParallelOnes) { expect_general(lancer_test::camera(CameraKind::Orthographic, {}), {.seed = 9}); }

TEST(CameraRays, LensesRoundSquashedAndBladed) {
  Camera camera = lancer_test::camera(CameraKind::Perspective, {});
  camera.lens_radius = 0.03;
  camera.focal_distance = 7.0;
  camera.aperture_ratio = 1.3;
  for (const uint32_t blades : {0u, 6u}) {
    camera.aperture_blades = blades;
    expect_general(camera, {.seed = 1});
  }
}

TEST(CameraRays, PanoramasWithPlacesThatShowNothing) {
  expect_general(lancer_test::camera(CameraKind::FisheyeEquidistant, {3.0}), {.seed = 2});
}

TEST(CameraRays, MiddlesOfPixels) {
  expect_general(lancer_test::camera(CameraKind::Perspective, {}),
                 {.integrator = static_cast<uint32_t>(IntegratorKind::Classic), .samples = 1});
}

// The last entry of the filter's table is used like the others.
TEST(CameraRays, WholeFilterInLanes) {
  // The first 2^14 samples of a pixel use every 2^-14 of the filter in both directions, including its ends.
  Camera camera = lancer_test::camera(CameraKind::Perspective, {});
  const IntegratorSettings settings{.pixel_filter = static_cast<uint32_t>(FilterKind::BlackmanHarris), .filter_width = 4.0f};
  const PixelFilter filter(settings.filter(), settings.filter_width);
  std::vector<SampleAddress> addresses;
  for (uint32_t sample = 0; sample < 1u << 14; ++sample)
    addresses.push_back({3, 4, sample});
  std::vector<SampleResult> results(addresses.size());
  for (const Started &found : start(camera, settings, addresses, results)) {
    const Sampler sampler(0, 3, 4, addresses[found.slot].sample);
    const glm::dvec2 offset(filter.sample(sampler.get1(0)), filter.sample(sampler.get1(1)));
    ASSERT_EQ(found.ray.d, camera.ray(glm::dvec2(3.5, 4.5) + offset, {}).d);
  }
}

// The spread of a pixel is the change to the rays of the pixels beside it; half a pixel further, the derivative errs by less
// than the square of a pixel's size at depth 1.
TEST(CameraRays, SpreadIsTheChangeToThePixelsBeside) {
  for (const double wide : {0.1, 1.0, 3.0})
    for (const uint32_t width : {64u, 1920u}) {
      Camera camera = lancer_test::camera(CameraKind::Perspective, {});
      camera.width = width;
      camera.height = width / 2;
      camera.left = -0.3 * wide;
      camera.right = 0.7 * wide;
      camera.bottom = -0.25 * wide;
      camera.top = 0.25 * wide;
      const PixelSpread spread(camera);
      const double size = wide / width;
      for (uint32_t i = 0; i <= 8; ++i)
        for (uint32_t k = 0; k <= 8; ++k) {
          const glm::dvec2 at(i / 8.0 * width, k / 8.0 * camera.height);
          const auto d = [&](double x, double y) {
            return glm::normalize(camera.ray(at + glm::dvec2(x, y), glm::dvec2(0.0)).d);
          };
          const double change = 0.5 * (glm::length(d(1, 0) - d(0, 0)) + glm::length(d(0, 1) - d(0, 0)));
          EXPECT_NEAR(spread(d(0, 0)) / change, 1.0, size * size) << wide << ", " << width << ", " << i << ", " << k;
        }
    }
}

} // namespace
