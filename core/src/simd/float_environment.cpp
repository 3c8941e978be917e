#include "simd/float_environment.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#include <cfenv>
#endif

namespace lancer {

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
