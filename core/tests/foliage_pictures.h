// Samples of foliage, straight from an integrator.
#pragma once

#include "foliage.h"

#include "integrator/sample.h"

namespace lancer_test {

struct Picture {
  std::vector<SampleResult> results;
  RayCounts counts;
};

// One sample of each of 40 x 40 pixels. one_by_one: replay each by itself.
inline Picture picture(const Scene &scene, const IntegratorSettings &settings, bool one_by_one = false) {
  constexpr uint32_t kPixels = 40;
  const Camera camera = camera_above(scene, kPixels);
  const auto integrator = make_integrator(scene, camera, settings);
  std::vector<SampleAddress> addresses;
  for (uint32_t i = 0; i < kPixels * kPixels; ++i)
    addresses.push_back({i % kPixels, i / kPixels, 0});
  Picture result;
  result.results.resize(addresses.size(), SampleResult(true));
  std::vector<PathVertex> vertices;
  if (one_by_one)
    for (size_t i = 0; i < addresses.size(); ++i)
      integrator->run({&addresses[i], 1}, {&result.results[i], 1}, &vertices);
  else
    integrator->run(addresses, result.results, nullptr);
  result.counts = integrator->counts();
  return result;
}

// Returns a vector of each sample.
template <class Ask> std::vector<glm::vec3> each(const Picture &picture, Ask &&ask) {
  std::vector<glm::vec3> all;
  for (const SampleResult &result : picture.results)
    all.push_back(ask(result));
  return all;
}

inline std::vector<glm::vec3> radiance(const Picture &picture) {
  return each(picture, [](const SampleResult &result) { return result.radiance; });
}

// Returns the mean over all pixels and components.
inline double mean_difference(const std::vector<glm::vec3> &a, const std::vector<glm::vec3> &b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 3; ++k)
      sum += std::abs(double(a[i][k]) - double(b[i][k])) / 3.0;
  return sum / double(a.size());
}

} // namespace lancer_test
