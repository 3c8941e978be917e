// Camera rays in vector registers, one copy per instruction set; all give the same bits, and those of the general code:
// Sampler, PixelFilter, Camera::ray().
#pragma once

#include "integrator/camera_block.h"

namespace lancer {

struct CameraKernel {
  const char *name;
  // Flat pictures through a pinhole or a round lens.
  void (*rays)(CameraBlock &block);
};

// Each is the same source, camera_kernel.cpp, compiled with LANCER_ISA set to the name.
#if defined(__x86_64__)
namespace sse4 {
extern const CameraKernel camera_kernel;
}
namespace avx2 {
extern const CameraKernel camera_kernel;
}
namespace avx512 {
extern const CameraKernel camera_kernel;
}
#else
namespace generic {
extern const CameraKernel camera_kernel;
}
#endif
// The one that this processor runs, or that LANCER_ISA asks for.
const CameraKernel &camera_kernel();

} // namespace lancer
