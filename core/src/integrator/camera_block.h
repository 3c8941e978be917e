// Camera rays side by side, from the address to the ray. Plain numbers: kernels read and write it.
#pragma once

#include <cstdint>

namespace lancer {

struct Camera;
struct FilterTable;

inline constexpr int kCameraLanes = 16;

struct alignas(64) CameraBlock {
  // Given: pixels of the full image, Sampler::replicate_key(), and the reversed points of the samples in the dimensions of
  // pixel and lens.
  uint32_t x[kCameraLanes], y[kCameraLanes], key[kCameraLanes], reversed_point[4][kCameraLanes];
  // Sampler::pixel(), and the ray.
  uint32_t pixel[kCameraLanes];
  double o[3][kCameraLanes], d[3][kCameraLanes];

  // Given: what all lanes share.
  const Camera *camera = nullptr;
  const FilterTable *filter = nullptr;
};

} // namespace lancer
