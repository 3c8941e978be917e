// Camera rays in vector registers, one copy per instruction set; all give the same bits, and those of the general code:
// Sampler, PixelFilter, Camera::ray().
#pragma once

#include "accel/kernel_choice.h"
#include "integrator/camera_block.h"

namespace lancer {

struct CameraKernel {
  const char *name;
  // Flat pictures through a pinhole or a round lens.
  void (*rays)(CameraBlock &block);
};

// Each is the same source, camera_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(CameraKernel, camera_kernel)

} // namespace lancer
