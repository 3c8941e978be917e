// Kernels are compiled once per instruction set; one copy of each runs.
#pragma once

#include "accel/instruction_set.h"

// LANCER_DECLARE_KERNEL: all copies of a kernel, and the function of its name that gives the one which this processor runs, or
// which LANCER_ISA asks for. LANCER_CHOSEN_KERNEL: what that function returns. LANCER_CHOSEN_SHADING_KERNEL: the same of a
// kernel that has a copy of one lane.
#if defined(__x86_64__)
#define LANCER_DECLARE_KERNEL(type, name)                                                                                      \
  namespace one_lane {                                                                                                         \
  extern const type name;                                                                                                      \
  }                                                                                                                            \
  namespace sse4 {                                                                                                             \
  extern const type name;                                                                                                      \
  }                                                                                                                            \
  namespace avx2 {                                                                                                             \
  extern const type name;                                                                                                      \
  }                                                                                                                            \
  namespace avx512 {                                                                                                           \
  extern const type name;                                                                                                      \
  }                                                                                                                            \
  const type &name();
#define LANCER_CHOSEN_KERNEL(name)                                                                                             \
  instruction_set() == InstructionSet::Avx512 ? avx512::name                                                                   \
  : instruction_set() == InstructionSet::Avx2 ? avx2::name                                                                     \
                                              : sse4::name
#else
#define LANCER_DECLARE_KERNEL(type, name)                                                                                      \
  namespace one_lane {                                                                                                         \
  extern const type name;                                                                                                      \
  }                                                                                                                            \
  namespace generic {                                                                                                          \
  extern const type name;                                                                                                      \
  }                                                                                                                            \
  const type &name();
#define LANCER_CHOSEN_KERNEL(name) generic::name
#endif
#define LANCER_CHOSEN_SHADING_KERNEL(name)                                                                                     \
  instruction_set() == InstructionSet::Scalar ? one_lane::name : LANCER_CHOSEN_KERNEL(name)
