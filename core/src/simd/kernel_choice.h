// Kernels are compiled once per instruction set, with LANCER_ISA naming it; one copy of each runs.
#pragma once

// Kernels are compiled once per instruction set, with LANCER_ISA naming it; the name as text.

#define LANCER_TEXT(x) #x
#define LANCER_TEXT_OF(x) LANCER_TEXT(x)
#define LANCER_ISA_NAME LANCER_TEXT_OF(LANCER_ISA)
#ifndef LANCER_ISA
#define LANCER_ISA generic
#endif

// Kernels are compiled once per instruction set; one copy of each runs.

// LANCER_DECLARE_KERNEL: all copies of a kernel, and the function of its name that gives the one which this processor runs, or
// which LANCER_ISA asks for. LANCER_CHOSEN_KERNEL: what that function returns. LANCER_CHOSEN_SHADING_KERNEL: the same of a
// kernel that has a copy of one lane.
#define LANCER_CHOSEN_SHADING_KERNEL(name)                                                                                     \
  instruction_set() == InstructionSet::Scalar ? one_lane::name : LANCER_CHOSEN_KERNEL(name)
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

namespace lancer {

// Which copy of the kernels runs.
enum class InstructionSet { Scalar, Generic, Sse4, Avx2, Avx512 };

// The best one that this processor runs, or the lesser one that the environment's LANCER_ISA asks for.
// Scalar: of shading a copy of one lane, in which a fault is easier to follow; of the rest the least one.
InstructionSet instruction_set();

} // namespace lancer
