// Surfaces in lanes, one copy per instruction set: all values that a surface answers, by name.
#pragma once

#include "bsdf/material_lobes.h"
#include "scene/lobe_inputs.h"
#include "simd/processor.h"

namespace lancer {

namespace testing {

// One lane's lobe.
struct Described {
  LobeInputs<float> lobe;
  PrincipledInputs<float> layers;
};

// One lane's directions and random numbers.
struct Place {
  static constexpr int kDirections = 3, kDraws = 4;

  glm::vec3 wo, ns, ng, wi[kDirections];
  glm::vec3 u[kDraws]; // of the lobe, of the direction
  bool inside;
};

} // namespace testing

// The bits of all values of a surface, a row each. All not-a-numbers are one: the compiler chooses the operand that a sum
// keeps.
struct BsdfRows {
  static constexpr int kLanes = 16, kMost = 360;

  struct Row {
    const char *name;
    uint32_t words[kLanes];
  };
  int count;
  Row rows[kMost];
};

struct BsdfKernel {
  const char *name;
  // Surfaces of count lobes; lobes[k] has the 16 lanes of lobe k, which have one code.
  void (*described)(const testing::Place *places, const testing::Described *const *lobes, int count, bool bump_correction,
                    BsdfRows &rows);
  // Surfaces of one lobe with planned facets; ready has one lobe for each of the 16 lanes, all of one code.
  void (*planned)(const testing::Place *places, const ReadyLobe *const *ready, bool layered, BsdfRows &rows);
};

// Each is the same source, bsdf_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(BsdfKernel, bsdf_kernel)

} // namespace lancer
