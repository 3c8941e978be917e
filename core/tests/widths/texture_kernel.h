// Computed textures and curves in lanes, one copy per instruction set.
#pragma once

#include "nodes/curves.h"
#include "simd/processor.h"

namespace lancer {

struct alignas(64) TextureInputs {
  static constexpr int kPlaces = 16, kRows = 11;

  float x[kRows][kPlaces];
};

struct alignas(64) TextureOutputs {
  float x[4][TextureInputs::kPlaces];
};

// Each function takes the rows of its vectors in their order: three rows for a vector.
struct TextureKernel {
  const char *name;
  void (*noise)(uint32_t kind, uint32_t flags, const TextureInputs &in, TextureOutputs &out);
  void (*voronoi)(uint32_t feature, uint32_t flags, const TextureInputs &in, TextureOutputs &out);
  void (*gradient)(uint32_t kind, const TextureInputs &in, TextureOutputs &out);
  void (*curve)(const CurveTable &table, const TextureInputs &in, TextureOutputs &out);
};

// Each is the same source, texture_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(TextureKernel, texture_kernel)

} // namespace lancer
