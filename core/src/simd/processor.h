// The processor that runs the code: its instruction set, which chooses a copy of each kernel, and its mode of float arithmetic.
// A kernel is compiled once per instruction set, with LANCER_ISA as its name, and one copy runs.
#pragma once

#include <cstdint>

// The instruction set's name as text.

#define LANCER_TEXT(x) #x
#define LANCER_TEXT_OF(x) LANCER_TEXT(x)
#define LANCER_ISA_NAME LANCER_TEXT_OF(LANCER_ISA)
#ifndef LANCER_ISA
#define LANCER_ISA generic
#endif

// LANCER_DECLARE_KERNEL declares all copies of a kernel, and the function of its name that returns the copy for this processor
// or for the environment variable LANCER_ISA. LANCER_CHOSEN_KERNEL is the body of this function. LANCER_CHOSEN_SHADING_KERNEL
// is the body for a kernel that also has a copy of one lane.
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

// The copy of the kernels that runs.
enum class InstructionSet { Scalar, Generic, Sse4, Avx2, Avx512 };

// Returns the best set that this processor supports, or the smaller one in the environment variable LANCER_ISA.
// Scalar: shading uses a copy of one lane, which is easier to debug; other kernels use the smallest set.
InstructionSet instruction_set();

// Sets the processor's float arithmetic to round-to-nearest with subnormals during its lifetime: other code in the same process
// may have set another mode, which threads inherit.
class FloatEnvironment {
public:
  FloatEnvironment();
  ~FloatEnvironment();
  FloatEnvironment(const FloatEnvironment &) = delete;
  FloatEnvironment &operator=(const FloatEnvironment &) = delete;

private:
  uint64_t saved_;
};

} // namespace lancer
