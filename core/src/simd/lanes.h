// Lanes: W paths in vector registers, W = 4, 8 or 16, in the instruction set of this translation unit; wider lanes use several
// registers. Every operation is that of IEEE 754 in each lane, so that a lane has the same bits as scalar code.
// Everything has internal linkage, so that no other unit can use this unit's instructions.
#pragma once

#include "simd/scalar.h"

#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace lancer {
namespace {

// Declared again, because operations of lanes would hide those of width 1.
using lancer::all;
using lancer::any;
using lancer::as_float;
using lancer::bits;
using lancer::to_float;

template <class T, int N> struct VectorType { typedef T type __attribute__((vector_size(sizeof(T) * N))); };
template <class T, int N> using VectorOf = typename VectorType<T, N>::type;

// The lanes in which a condition holds.
template <int W> struct Mask {
  VectorOf<int32_t, W> v;

  friend LANCER_LANE Mask operator&(Mask a, Mask b) { return {a.v & b.v}; }
  friend LANCER_LANE Mask operator|(Mask a, Mask b) { return {a.v | b.v}; }
  friend LANCER_LANE Mask operator!(Mask a) { return {~a.v}; }
  friend LANCER_LANE Mask operator!=(Mask a, Mask b) { return {a.v ^ b.v}; }
  friend LANCER_LANE Mask select(Mask m, Mask a, Mask b) { return (m & a) | ((!m) & b); }
};

#if defined(__AVX512F__)
// GCC 12 warns about the undefined operands of the plain intrinsics; the forms with a full mask compile to the same
// instructions.
constexpr __mmask16 kAllLanes = 0xffff;
constexpr __mmask8 kHalfLanes = 0xff;
template <> struct Mask<16> {
  uint32_t v;

  friend LANCER_LANE Mask operator&(Mask a, Mask b) { return {a.v & b.v}; }
  friend LANCER_LANE Mask operator|(Mask a, Mask b) { return {a.v | b.v}; }
  friend LANCER_LANE Mask operator!(Mask a) { return {~a.v & 0xffffu}; }
  friend LANCER_LANE Mask operator!=(Mask a, Mask b) { return {a.v ^ b.v}; }
  friend LANCER_LANE Mask select(Mask m, Mask a, Mask b) { return (m & a) | ((!m) & b); }
};
LANCER_LANE uint32_t bits(Mask<16> m) { return m.v; }
#endif

template <int W> LANCER_LANE uint32_t bits(Mask<W> m) {
#if defined(__AVX__)
  if constexpr (W == 8)
    return static_cast<uint32_t>(_mm256_movemask_ps((__m256)m.v));
#endif
#if defined(__SSE2__)
  if constexpr (W == 4)
    return static_cast<uint32_t>(_mm_movemask_ps((__m128)m.v));
#endif
  uint32_t r = 0;
  for (int i = 0; i < W; ++i)
    r |= static_cast<uint32_t>(m.v[i] & 1) << i;
  return r;
}
template <int W> LANCER_LANE bool any(Mask<W> m) { return bits(m) != 0; }
template <int W> LANCER_LANE bool all(Mask<W> m) { return bits(m) == (1u << W) - 1u; }

// Returns the mask of the set bits.
template <int W> LANCER_LANE Mask<W> mask_from(uint32_t bits) {
#if defined(__AVX512F__)
  if constexpr (W == 16)
    return {bits};
  else
#endif
  {
    VectorOf<int32_t, W> lane{};
    for (int i = 0; i < W; ++i)
      lane[i] = static_cast<int32_t>(1u << i);
    return {((static_cast<int32_t>(bits) - VectorOf<int32_t, W>{}) & lane) != 0};
  }
}

// Conversion between a condition of floats and the two halves of a condition of doubles.
template <int W, int... I>
LANCER_LANE VectorOf<int32_t, W> narrow_halves(VectorOf<int64_t, W / 2> lo, VectorOf<int64_t, W / 2> hi,
                                               std::integer_sequence<int, I...>) {
  return __builtin_shufflevector((VectorOf<int32_t, W>)lo, (VectorOf<int32_t, W>)hi, (2 * I)...);
}
template <int W, int First, int... I>
LANCER_LANE VectorOf<int64_t, W / 2> widen_half(VectorOf<int32_t, W> m, std::integer_sequence<int, I...>) {
  return (VectorOf<int64_t, W / 2>)__builtin_shufflevector(m, m, (First + I / 2)...);
}
template <int W> LANCER_LANE VectorOf<int64_t, W / 2> low_half(Mask<W> m) {
  return widen_half<W, 0>(m.v, std::make_integer_sequence<int, W>());
}
template <int W> LANCER_LANE VectorOf<int64_t, W / 2> high_half(Mask<W> m) {
  return widen_half<W, W / 2>(m.v, std::make_integer_sequence<int, W>());
}

template <int W> struct Word {
  using Vector = VectorOf<uint32_t, W>;
  Vector v;
  Word() = default;
  LANCER_LANE Word(Vector x) : v(x) {}
  LANCER_LANE Word(uint32_t x) : v(x - Vector{}) {}

  friend LANCER_LANE Word operator+(Word a, Word b) { return Word(a.v + b.v); }
  friend LANCER_LANE Word operator-(Word a, Word b) { return Word(a.v - b.v); }
  friend LANCER_LANE Word operator*(Word a, Word b) { return Word(a.v * b.v); }
  friend LANCER_LANE Word operator&(Word a, Word b) { return Word(a.v & b.v); }
  friend LANCER_LANE Word operator|(Word a, Word b) { return Word(a.v | b.v); }
  friend LANCER_LANE Word operator^(Word a, Word b) { return Word(a.v ^ b.v); }
  friend LANCER_LANE Word operator>>(Word a, int n) { return Word(a.v >> n); }
  friend LANCER_LANE Word operator<<(Word a, int n) { return Word(a.v << n); }
  friend LANCER_LANE Mask<W> equal(Word a, Word b) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return {_mm512_cmpeq_epi32_mask((__m512i)a.v, (__m512i)b.v)};
    else
#endif
      return {a.v == b.v};
  }
  friend LANCER_LANE Word select(Mask<W> m, Word a, Word b) {
#if defined(__AVX2__)
    // GCC 12 would compare the mask with 0 before the blend.
    if constexpr (W == 8)
      return Word((Vector)_mm256_blendv_epi8((__m256i)b.v, (__m256i)a.v, (__m256i)m.v));
#endif
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Word((Vector)_mm512_mask_blend_epi32(static_cast<__mmask16>(m.v), (__m512i)b.v, (__m512i)a.v));
    else
#endif
      return Word(m.v ? a.v : b.v);
  }
};

template <int W> struct Float {
  using Vector = VectorOf<float, W>;
  Vector v;
  Float() = default;
  LANCER_LANE Float(Vector x) : v(x) {}
  LANCER_LANE Float(float x) : v(x - Vector{}) {}

  friend LANCER_LANE Float operator+(Float a, Float b) { return Float(a.v + b.v); }
  friend LANCER_LANE Float operator-(Float a, Float b) { return Float(a.v - b.v); }
  friend LANCER_LANE Float operator*(Float a, Float b) { return Float(a.v * b.v); }
  friend LANCER_LANE Float operator/(Float a, Float b) { return Float(a.v / b.v); }
  friend LANCER_LANE Float operator-(Float a) { return Float(-a.v); }
  LANCER_LANE Float &operator+=(Float b) { return *this = *this + b; }
  LANCER_LANE Float &operator-=(Float b) { return *this = *this - b; }
  LANCER_LANE Float &operator*=(Float b) { return *this = *this * b; }
  LANCER_LANE Float &operator/=(Float b) { return *this = *this / b; }

#if defined(__AVX512F__)
#define LANCER_COMPARE(op, number)                                                                                             \
  friend LANCER_LANE Mask<W> operator op(Float a, Float b) {                                                                   \
    if constexpr (W == 16)                                                                                                     \
      return {_mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, number)};                                                           \
    else                                                                                                                       \
      return {a.v op b.v};                                                                                                     \
  }
#else
#define LANCER_COMPARE(op, number)                                                                                             \
  friend LANCER_LANE Mask<W> operator op(Float a, Float b) { return {a.v op b.v}; }
#endif
  LANCER_COMPARE(<, _CMP_LT_OQ)
  LANCER_COMPARE(<=, _CMP_LE_OQ)
  LANCER_COMPARE(>, _CMP_GT_OQ)
  LANCER_COMPARE(>=, _CMP_GE_OQ)
  LANCER_COMPARE(==, _CMP_EQ_OQ)
  LANCER_COMPARE(!=, _CMP_NEQ_UQ)
#undef LANCER_COMPARE

  friend LANCER_LANE Float select(Mask<W> m, Float a, Float b) {
#if defined(__AVX2__)
    if constexpr (W == 8)
      return Float((Vector)_mm256_blendv_ps((__m256)b.v, (__m256)a.v, (__m256)m.v));
#endif
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Float((Vector)_mm512_mask_blend_ps(static_cast<__mmask16>(m.v), (__m512)b.v, (__m512)a.v));
    else
#endif
      return Float(m.v ? a.v : b.v);
  }
  // Returns the first if they are equal or unordered, as std::max and std::min.
  friend LANCER_LANE Float max(Float a, Float b) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Float((Vector)_mm512_maskz_max_ps(kAllLanes, (__m512)b.v, (__m512)a.v));
#endif
#if defined(__AVX__)
    if constexpr (W == 8)
      return Float((Vector)_mm256_max_ps((__m256)b.v, (__m256)a.v));
#endif
    return select(a < b, b, a);
  }
  friend LANCER_LANE Float min(Float a, Float b) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Float((Vector)_mm512_maskz_min_ps(kAllLanes, (__m512)b.v, (__m512)a.v));
#endif
#if defined(__AVX__)
    if constexpr (W == 8)
      return Float((Vector)_mm256_min_ps((__m256)b.v, (__m256)a.v));
#endif
    return select(b < a, b, a);
  }
  friend LANCER_LANE Float sqrt(Float a) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Float((Vector)_mm512_maskz_sqrt_ps(kAllLanes, (__m512)a.v));
#endif
#if defined(__AVX__)
    if constexpr (W == 8)
      return Float((Vector)_mm256_sqrt_ps((__m256)a.v));
#endif
    for (int i = 0; i < W; ++i)
      a.v[i] = __builtin_sqrtf(a.v[i]);
    return a;
  }
  // Returns the largest whole number not above a.
  friend LANCER_LANE Float floor(Float a) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Float((Vector)_mm512_maskz_roundscale_ps(kAllLanes, (__m512)a.v, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
#endif
#if defined(__AVX__)
    if constexpr (W == 8)
      return Float((Vector)_mm256_floor_ps((__m256)a.v));
#endif
#if defined(__SSE4_1__)
    if constexpr (W == 4)
      return Float((Vector)_mm_floor_ps((__m128)a.v));
#endif
    for (int i = 0; i < W; ++i)
      a.v[i] = __builtin_floorf(a.v[i]);
    return a;
  }
  friend LANCER_LANE Word<W> as_word(Float a) { return Word<W>((VectorOf<uint32_t, W>)a.v); }
  friend LANCER_LANE Float abs(Float a) { return as_float(as_word(a) & Word<W>(0x7fffffffu)); }
  friend LANCER_LANE Float copysign(Float magnitude, Float sign) {
    return as_float((as_word(magnitude) & Word<W>(0x7fffffffu)) | (as_word(sign) & Word<W>(0x80000000u)));
  }
  // Rounds towards zero; the value must fit an int32.
  friend LANCER_LANE Word<W> truncate(Float a) {
    return Word<W>((VectorOf<uint32_t, W>)__builtin_convertvector(a.v, VectorOf<int32_t, W>));
  }
};
template <int W> LANCER_LANE float lane(Float<W> a, int i) { return a.v[i]; }
template <int W> LANCER_LANE uint32_t lane(Word<W> a, int i) { return a.v[i]; }
template <int W, class Function> LANCER_LANE Float<W> each(Float<W> a, const Function &f) {
  for (int i = 0; i < W; ++i)
    a.v[i] = f(a.v[i]);
  return a;
}
template <int W, class Function> LANCER_LANE Float<W> each(Float<W> a, Float<W> b, const Function &f) {
  for (int i = 0; i < W; ++i)
    a.v[i] = f(a.v[i], b.v[i]);
  return a;
}
template <int W> LANCER_LANE Float<W> as_float(Word<W> a) { return Float<W>((VectorOf<float, W>)a.v); }
template <int W> LANCER_LANE Float<W> to_float(Word<W> a) {
  return Float<W>(__builtin_convertvector((VectorOf<int32_t, W>)a.v, VectorOf<float, W>));
}

} // namespace
} // namespace lancer
