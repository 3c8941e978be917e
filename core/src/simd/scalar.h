// A single number as lanes of width 1: the operations of lanes besides arithmetic, for float, double, uint32_t and bool. A
// formula that is a template over its number type is thereby also scalar code.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#define LANCER_LANE __attribute__((always_inline)) inline

// A table that kernels read and one source file defines: in the memory of the processor that runs them.
#if defined(__CUDA__)
#define LANCER_TABLE extern __attribute__((device)) const
#else
#define LANCER_TABLE extern const
#endif

namespace lancer {

// Conditions of width 1.
LANCER_LANE bool any(bool m) { return m; }
LANCER_LANE bool all(bool m) { return m; }
LANCER_LANE uint32_t bits(bool m) { return m ? 1u : 0u; }

LANCER_LANE float select(bool m, float a, float b) { return m ? a : b; }
LANCER_LANE double select(bool m, double a, double b) { return m ? a : b; }
LANCER_LANE uint32_t select(bool m, uint32_t a, uint32_t b) { return m ? a : b; }
LANCER_LANE bool select(bool m, bool a, bool b) { return m ? a : b; }

// Returns the first if they are equal or unordered, as std::max and std::min.
LANCER_LANE float max(float a, float b) { return a < b ? b : a; }
LANCER_LANE float min(float a, float b) { return b < a ? b : a; }
LANCER_LANE double max(double a, double b) { return a < b ? b : a; }
LANCER_LANE double min(double a, double b) { return b < a ? b : a; }

LANCER_LANE float sqrt(float a) { return __builtin_sqrtf(a); }
LANCER_LANE double sqrt(double a) { return __builtin_sqrt(a); }
LANCER_LANE float abs(float a) { return __builtin_fabsf(a); }
LANCER_LANE double abs(double a) { return __builtin_fabs(a); }
LANCER_LANE float floor(float a) { return __builtin_floorf(a); }
LANCER_LANE float copysign(float magnitude, float sign) { return __builtin_copysignf(magnitude, sign); }

// Returns 1 with the sign of a.
LANCER_LANE double sign(double a) { return __builtin_copysign(1.0, a); }

LANCER_LANE float as_float(uint32_t a) { return std::bit_cast<float>(a); }
LANCER_LANE uint32_t as_word(float a) { return std::bit_cast<uint32_t>(a); }
LANCER_LANE bool equal(uint32_t a, uint32_t b) { return a == b; }

LANCER_LANE double widen(float a) { return static_cast<double>(a); }
LANCER_LANE float narrow(double a) {
  float r = static_cast<float>(a);
#if defined(__GNUC__) && !defined(__clang__)
  // GCC 12 vectorises several conversions and drops those to floats and back: (double)(float)x would be x. The asm statement
  // hides the value from the optimiser.
#if defined(__x86_64__)
  asm("" : "+x"(r));
#elif defined(__aarch64__)
  asm("" : "+w"(r));
#endif
#endif
  return r;
}
// Rounds towards zero, for values that fit an int32; and converts back.
LANCER_LANE uint32_t truncate(float a) { return static_cast<uint32_t>(static_cast<int32_t>(a)); }
LANCER_LANE uint32_t truncate(double a) { return static_cast<uint32_t>(static_cast<int32_t>(a)); }
LANCER_LANE float to_float(uint32_t a) { return static_cast<float>(static_cast<int32_t>(a)); }

LANCER_LANE float gather(const float *table, uint32_t index) { return table[index]; }
LANCER_LANE double gather(const double *table, uint32_t index) { return table[index]; }
LANCER_LANE uint32_t gather(const uint32_t *table, uint32_t index) { return table[index]; }
// Returns the word at a byte offset.
LANCER_LANE uint32_t gather_bytes(const void *table, uint32_t offset) {
  uint32_t word;
  __builtin_memcpy(&word, static_cast<const unsigned char *>(table) + offset, 4);
  return word;
}

// The number types with as many lanes as F.
template <class F> struct LanesOf;
template <> struct LanesOf<float> {
  static constexpr int kWidth = 1;
  using Double = double;
  using Word = uint32_t;
  using Mask = bool;
  static LANCER_LANE Mask uniform(bool m) { return m; }
};
// float or lanes of it.
template <class F>
concept FloatLanes = requires {
  typename LanesOf<F>::Double;
};
template <class F> using DoubleOf = typename LanesOf<F>::Double;
template <class F> using WordOf = typename LanesOf<F>::Word;
template <class F> using MaskOf = typename LanesOf<F>::Mask;
// Returns the same condition in all lanes.
template <class F> LANCER_LANE MaskOf<F> uniform(bool m) { return LanesOf<F>::uniform(m); }

// lane() returns one lane; from_lanes() builds lanes from a function of the lane number.
LANCER_LANE float lane(float a, int) { return a; }
LANCER_LANE double lane(double a, int) { return a; }
LANCER_LANE uint32_t lane(uint32_t a, int) { return a; }
template <class F, class Function> LANCER_LANE F from_lanes(const Function &f) {
  if constexpr (LanesOf<F>::kWidth == 1)
    return f(0);
  else {
    // Write the lanes to memory: insertions into a register would wait for each other.
    alignas(64) decltype(f(0)) of[LanesOf<F>::kWidth];
    for (int i = 0; i < LanesOf<F>::kWidth; ++i)
      of[i] = f(i);
    F r;
    __builtin_memcpy(&r, of, sizeof(r));
    return r;
  }
}

// Applies a scalar function to every lane, for code too rare for a vector version.
template <class Function> LANCER_LANE float each(float a, const Function &f) { return f(a); }
template <class Function> LANCER_LANE double each(double a, const Function &f) { return f(a); }
template <class Function> LANCER_LANE float each(float a, float b, const Function &f) { return f(a, b); }

} // namespace lancer
