// Pictures in vector registers: of the environment and on surfaces. One copy per instruction set; all give the same bits, and
// those of the general code: Environment, lookup().
#pragma once

#include "accel/kernel_choice.h"
#include "integrator/picture_block.h"
#include "lights/wide_sky.h"

namespace lancer {

// lanes: bits of those to fill; the others stay as they are.
struct PictureKernel {
  const char *name;
  // Directions as samples of a light, from the numbers for it; light_pdf holds the probability of its choice. Radiance where
  // there is a picture.
  void (*sample_sky)(VertexBlock &block, const WideSky &sky, uint32_t lanes);
  void (*look_at_sky)(SkyBlock &block, const WideSky &sky);
  void (*look_up)(ColorBlock &block, const WideImage &image, uint32_t lanes);
};

// Each is the same source, picture_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(PictureKernel, picture_kernel)

} // namespace lancer
