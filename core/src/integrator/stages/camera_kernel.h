// Camera rays in lanes: the block of samples and the kernel that fills it.
#pragma once

#include "simd/kernel_choice.h"

#include <cstdint>

namespace lancer {

// Camera rays in lanes, from the address to the ray. Kernels read and write these plain numbers.
struct Camera;
struct FilterTable;

inline constexpr int kCameraLanes = 16;

struct alignas(64) CameraBlock {
  // Input: pixels of the full image, and the reversed points of the samples in the dimensions of pixel and lens.
  uint32_t x[kCameraLanes], y[kCameraLanes], reversed_point[4][kCameraLanes];
  // Output: Sampler::pixel() and the ray.
  uint32_t pixel[kCameraLanes];
  double o[3][kCameraLanes], d[3][kCameraLanes];

  // Input shared by all lanes. key: hash of the seed.
  uint32_t key = 0;
  const Camera *camera = nullptr;
  const FilterTable *filter = nullptr;
};

// Camera rays in lanes, one copy per instruction set; all copies give the same bits as Sampler, PixelFilter and Camera::ray().
struct CameraKernel {
  const char *name;
  // Makes the rays of flat pictures through a pinhole or a round lens.
  void (*rays)(CameraBlock &block);
};

// Each copy is camera_kernel.cpp compiled with LANCER_ISA set to its name.
LANCER_DECLARE_KERNEL(CameraKernel, camera_kernel)

} // namespace lancer
