#include "simd/processor.h"

#include <cstdint>
#include <cstdlib>
#include <string_view>

#if defined(__x86_64__)
#include <cpuid.h>
#endif
#if defined(__SSE2__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#include <cfenv>
#endif

namespace lancer {

#if defined(__x86_64__)
namespace {

struct Registers {
  uint32_t b = 0, c = 0;
};

// Returns the registers of a CPUID leaf; zeros if the processor does not have the leaf.
Registers ask(uint32_t leaf) {
  uint32_t a, b, c, d;
  return __get_cpuid_count(leaf, 0, &a, &b, &c, &d) ? Registers{b, c} : Registers{};
}

bool has(uint32_t present, uint32_t bits) { return (present & bits) == bits; }

// Returns the registers that the operating system saves for each thread: XCR0.
uint32_t saved_registers() {
  uint32_t low, high;
  asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

// Queries the processor directly, because some runtime libraries behind __builtin_cpu_supports report no features.
InstructionSet best_set() {
  const uint32_t basic = ask(1).c, more = ask(7).b, extended = ask(0x80000001).c;
  // Require all of x86-64-v3: the compiler may use any of it.
  if (!has(basic, bit_OSXSAVE | bit_AVX | bit_F16C | bit_FMA | bit_MOVBE) || !has(more, bit_AVX2 | bit_BMI | bit_BMI2) ||
      !has(extended, bit_LZCNT) || !has(saved_registers(), 0x06))
    return InstructionSet::Sse4;
#if defined(__APPLE__)
  // Darwin saves the wide registers from a thread's first use on, and reports them only then.
  const bool wide_saved = true;
#else
  const bool wide_saved = has(saved_registers(), 0xe6);
#endif
  // Additions of x86-64-v4.
  const uint32_t wide = bit_AVX512F | bit_AVX512BW | bit_AVX512CD | bit_AVX512DQ | bit_AVX512VL;
  return wide_saved && has(more, wide) ? InstructionSet::Avx512 : InstructionSet::Avx2;
}

} // namespace

InstructionSet instruction_set() {
  // Queried once: in a virtual machine each CPUID costs as much as a thousand instructions.
  static const InstructionSet best = best_set();
  const char *asked = std::getenv("LANCER_ISA");
  const std::string_view limit = asked ? asked : "";
  if (limit == "scalar")
    return InstructionSet::Scalar;
  if (best == InstructionSet::Sse4 || limit == "sse4")
    return InstructionSet::Sse4;
  return limit == "avx2" ? InstructionSet::Avx2 : best;
}

#else

InstructionSet instruction_set() {
  const char *asked = std::getenv("LANCER_ISA");
  return asked && std::string_view(asked) == "scalar" ? InstructionSet::Scalar : InstructionSet::Generic;
}

#endif

namespace {

#if defined(__SSE2__)
// MXCSR with every exception masked and all other bits zero: round to nearest, with subnormals.
constexpr uint64_t kPlainFloats = 0x1f80;
uint64_t float_control() { return _mm_getcsr(); }
void set_float_control(uint64_t value) { _mm_setcsr(static_cast<uint32_t>(value)); }
#elif defined(__aarch64__)
constexpr uint64_t kPlainFloats = 0;
uint64_t float_control() {
  uint64_t value;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}
void set_float_control(uint64_t value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
#else
// Standard C controls only the rounding mode.
constexpr uint64_t kPlainFloats = FE_TONEAREST;
uint64_t float_control() { return uint64_t(std::fegetround()); }
void set_float_control(uint64_t value) { std::fesetround(int(value)); }
#endif

} // namespace

FloatEnvironment::FloatEnvironment() : saved_(float_control()) { set_float_control(kPlainFloats); }
FloatEnvironment::~FloatEnvironment() { set_float_control(saved_); }

} // namespace lancer
