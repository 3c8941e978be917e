// Formulas in the lanes of a kernel, one copy per instruction set.
#pragma once

#include "lights/light_choice.h"
#include "sampling/direction_map.h"
#include "sampling/pixel_filter.h"
#include "simd/processor.h"

namespace lancer {

// Inputs of all formulas: sixteen of each kind, one for each lane, and the inputs that all lanes share.
struct alignas(64) WidthInputs {
  static constexpr int kCount = 16;

  float unit[4][kCount];              // in [0, 1)
  float number[3][kCount];            // any
  double wide_number[3][kCount];      // any
  uint32_t word[3][kCount];           // any
  float whole[kCount];                // of what an int32 holds, with a fraction
  double p[3][kCount], wi[3][kCount]; // wi: unit
  float n[3][kCount];                 // unit
  double end[kCount], choice[kCount]; // choice: in [0, 1)
  const Light *light[kCount];
  const TreeLight *tree_light = nullptr;
  LightNodes tree{};
  const FilterTable *filter = nullptr;
  DirectionTable map;
};

// Bits of all numbers that a formula gives, a row each.
struct WidthOutputs {
  static constexpr int kMost = 64;

  int rows = 0;
  bool is_float[kMost], is_double[kMost]; // else words, or conditions
  uint64_t bits[kMost][WidthInputs::kCount];
};

struct WidthFormula {
  const char *name;
  void (*run)(const WidthInputs &in, WidthOutputs &out);
};

struct WidthKernel {
  const char *name;
  const WidthFormula *numbers, *samples, *lights; // of simd/, sampling/ and lights/, the last of each without a name
};

// Each is the same source, width_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(WidthKernel, width_kernel)

} // namespace lancer
