// Lanes: the same number of several paths side by side in vector registers, in the instruction set that this translation unit
// is compiled for. Every operation is that of IEEE 754 in each lane, so that a lane holds the bits that a scalar would.
// For kernels only: everything has internal linkage, so that no other unit can pick up this unit's instructions.
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace lancer {
namespace {

#define LANCER_LANE [[gnu::always_inline]] inline

#if defined(__AVX512F__)
constexpr int kLanes = 16;
#elif defined(__AVX__)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif
constexpr int kHalf = kLanes / 2;

using FloatVector = float __attribute__((vector_size(4 * kLanes)));
using IntVector = int32_t __attribute__((vector_size(4 * kLanes)));
using WordVector = uint32_t __attribute__((vector_size(4 * kLanes)));
using DoubleVector = double __attribute__((vector_size(4 * kLanes)));
using HalfFloatVector = float __attribute__((vector_size(2 * kLanes)));

struct F {
  FloatVector v;
  F() = default;
  LANCER_LANE F(FloatVector x) : v(x) {}
  LANCER_LANE F(float x) : v(x - FloatVector{}) {}
};
struct U {
  WordVector v;
  U() = default;
  LANCER_LANE U(WordVector x) : v(x) {}
  LANCER_LANE U(uint32_t x) : v(x - WordVector{}) {}
};
struct D {
  DoubleVector lo, hi;
  D() = default;
  LANCER_LANE D(DoubleVector a, DoubleVector b) : lo(a), hi(b) {}
  LANCER_LANE D(double x) : lo(x - DoubleVector{}), hi(x - DoubleVector{}) {}
};

// Which lanes a condition holds in.
#if defined(__AVX512F__)
// GCC 12 warns of what the plain forms of the intrinsics leave undefined; those with a full mask become the same instructions.
constexpr __mmask16 kAllLanes = 0xffff;
constexpr __mmask8 kHalfLanes = 0xff;
struct M {
  uint32_t v;
};
LANCER_LANE M operator&(M a, M b) { return {a.v & b.v}; }
LANCER_LANE M operator|(M a, M b) { return {a.v | b.v}; }
LANCER_LANE M operator!(M a) { return {~a.v & 0xffffu}; }
LANCER_LANE M operator!=(M a, M b) { return {a.v ^ b.v}; }
LANCER_LANE uint32_t bits(M m) { return m.v; }
LANCER_LANE M mask_of(uint32_t bits) { return {bits}; }
template <int Op> LANCER_LANE M compare(F a, F b) { return {_mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, Op)}; }
template <int Op> LANCER_LANE M compare(D a, D b) {
  const uint32_t lo = _mm512_cmp_pd_mask((__m512d)a.lo, (__m512d)b.lo, Op);
  const uint32_t hi = _mm512_cmp_pd_mask((__m512d)a.hi, (__m512d)b.hi, Op);
  return {lo | hi << 8};
}
LANCER_LANE M equal(U a, U b) { return {_mm512_cmpeq_epi32_mask((__m512i)a.v, (__m512i)b.v)}; }
LANCER_LANE F select(M m, F a, F b) {
  return F((FloatVector)_mm512_mask_blend_ps(static_cast<__mmask16>(m.v), (__m512)b.v, (__m512)a.v));
}
LANCER_LANE U select(M m, U a, U b) {
  return U((WordVector)_mm512_mask_blend_epi32(static_cast<__mmask16>(m.v), (__m512i)b.v, (__m512i)a.v));
}
LANCER_LANE D select(M m, D a, D b) {
  return {(DoubleVector)_mm512_mask_blend_pd(static_cast<__mmask8>(m.v), (__m512d)b.lo, (__m512d)a.lo),
          (DoubleVector)_mm512_mask_blend_pd(static_cast<__mmask8>(m.v >> 8), (__m512d)b.hi, (__m512d)a.hi)};
}
#define LANCER_COMPARE(type, name, op)                                                                                         \
  LANCER_LANE M name(type a, type b) { return compare<op>(a, b); }
LANCER_COMPARE(F, operator<, _CMP_LT_OQ)
LANCER_COMPARE(F, operator<=, _CMP_LE_OQ)
LANCER_COMPARE(F, operator>, _CMP_GT_OQ)
LANCER_COMPARE(F, operator>=, _CMP_GE_OQ)
LANCER_COMPARE(F, operator==, _CMP_EQ_OQ)
LANCER_COMPARE(F, operator!=, _CMP_NEQ_UQ)
LANCER_COMPARE(D, operator<, _CMP_LT_OQ)
LANCER_COMPARE(D, operator<=, _CMP_LE_OQ)
LANCER_COMPARE(D, operator>, _CMP_GT_OQ)
LANCER_COMPARE(D, operator>=, _CMP_GE_OQ)
LANCER_COMPARE(D, operator==, _CMP_EQ_OQ)
LANCER_COMPARE(D, operator!=, _CMP_NEQ_UQ)
#undef LANCER_COMPARE
#else
using LongVector = int64_t __attribute__((vector_size(4 * kLanes)));
using HalfIntVector = int32_t __attribute__((vector_size(2 * kLanes)));
struct M {
  IntVector v;
};
LANCER_LANE M operator&(M a, M b) { return {a.v & b.v}; }
LANCER_LANE M operator|(M a, M b) { return {a.v | b.v}; }
LANCER_LANE M operator!(M a) { return {~a.v}; }
LANCER_LANE M operator!=(M a, M b) { return {a.v ^ b.v}; }
LANCER_LANE uint32_t bits(M m) {
#if defined(__AVX__)
  return static_cast<uint32_t>(_mm256_movemask_ps((__m256)m.v));
#elif defined(__SSE2__)
  return static_cast<uint32_t>(_mm_movemask_ps((__m128)m.v));
#else
  uint32_t r = 0;
  for (int i = 0; i < kLanes; ++i)
    r |= static_cast<uint32_t>(m.v[i] & 1) << i;
  return r;
#endif
}
LANCER_LANE M mask_of(uint32_t bits) {
  IntVector lane{};
  for (int i = 0; i < kLanes; ++i)
    lane[i] = static_cast<int32_t>(1u << i);
  return {((static_cast<int32_t>(bits) - IntVector{}) & lane) != 0};
}
// One condition of doubles from its two halves.
LANCER_LANE M narrow(LongVector lo, LongVector hi) {
  const HalfIntVector a = __builtin_convertvector(lo, HalfIntVector), b = __builtin_convertvector(hi, HalfIntVector);
  M m;
  for (int i = 0; i < kHalf; ++i) {
    m.v[i] = a[i];
    m.v[i + kHalf] = b[i];
  }
  return m;
}
LANCER_LANE LongVector widen_low(M m) {
  HalfIntVector a;
  for (int i = 0; i < kHalf; ++i)
    a[i] = m.v[i];
  return __builtin_convertvector(a, LongVector);
}
LANCER_LANE LongVector widen_high(M m) {
  HalfIntVector a;
  for (int i = 0; i < kHalf; ++i)
    a[i] = m.v[i + kHalf];
  return __builtin_convertvector(a, LongVector);
}
LANCER_LANE M equal(U a, U b) { return {a.v == b.v}; }
LANCER_LANE F select(M m, F a, F b) { return F(m.v ? a.v : b.v); }
LANCER_LANE U select(M m, U a, U b) { return U(m.v ? a.v : b.v); }
LANCER_LANE D select(M m, D a, D b) { return {widen_low(m) ? a.lo : b.lo, widen_high(m) ? a.hi : b.hi}; }
#define LANCER_COMPARE(op)                                                                                                     \
  LANCER_LANE M operator op(F a, F b) { return {a.v op b.v}; }                                                                 \
  LANCER_LANE M operator op(D a, D b) { return narrow(a.lo op b.lo, a.hi op b.hi); }
LANCER_COMPARE(<)
LANCER_COMPARE(<=)
LANCER_COMPARE(>)
LANCER_COMPARE(>=)
LANCER_COMPARE(==)
LANCER_COMPARE(!=)
#undef LANCER_COMPARE
#endif

LANCER_LANE bool any(M m) { return bits(m) != 0; }
// Of a block's bits, those of the lanes from first on.
LANCER_LANE M some(uint32_t lanes, int first) { return mask_of(lanes >> first & ((1u << kLanes) - 1u)); }

#define LANCER_OPERATOR(op)                                                                                                    \
  LANCER_LANE F operator op(F a, F b) { return F(a.v op b.v); }                                                                \
  LANCER_LANE D operator op(D a, D b) { return {a.lo op b.lo, a.hi op b.hi}; }
LANCER_OPERATOR(+)
LANCER_OPERATOR(-)
LANCER_OPERATOR(*)
LANCER_OPERATOR(/)
#undef LANCER_OPERATOR
LANCER_LANE F operator-(F a) { return F(-a.v); }
LANCER_LANE D operator-(D a) { return {-a.lo, -a.hi}; }

#define LANCER_OPERATOR(op)                                                                                                    \
  LANCER_LANE U operator op(U a, U b) { return U(a.v op b.v); }
LANCER_OPERATOR(+)
LANCER_OPERATOR(-)
LANCER_OPERATOR(*)
LANCER_OPERATOR(&)
LANCER_OPERATOR(|)
LANCER_OPERATOR(^)
#undef LANCER_OPERATOR
LANCER_LANE U operator>>(U a, int n) { return U(a.v >> n); }
LANCER_LANE U operator<<(U a, int n) { return U(a.v << n); }

// std::max and std::min: the first where they are equal or not ordered.
LANCER_LANE F max(F a, F b) {
#if defined(__AVX512F__)
  return F((FloatVector)_mm512_maskz_max_ps(kAllLanes, (__m512)b.v, (__m512)a.v));
#elif defined(__AVX__)
  return F((FloatVector)_mm256_max_ps((__m256)b.v, (__m256)a.v));
#else
  return select(a < b, b, a);
#endif
}
LANCER_LANE F min(F a, F b) {
#if defined(__AVX512F__)
  return F((FloatVector)_mm512_maskz_min_ps(kAllLanes, (__m512)b.v, (__m512)a.v));
#elif defined(__AVX__)
  return F((FloatVector)_mm256_min_ps((__m256)b.v, (__m256)a.v));
#else
  return select(b < a, b, a);
#endif
}
LANCER_LANE D max(D a, D b) { return select(a < b, b, a); }
LANCER_LANE D min(D a, D b) { return select(b < a, b, a); }

LANCER_LANE F sqrt(F a) {
#if defined(__AVX512F__)
  return F((FloatVector)_mm512_maskz_sqrt_ps(kAllLanes, (__m512)a.v));
#elif defined(__AVX__)
  return F((FloatVector)_mm256_sqrt_ps((__m256)a.v));
#else
  for (int i = 0; i < kLanes; ++i)
    a.v[i] = __builtin_sqrtf(a.v[i]);
  return a;
#endif
}
LANCER_LANE D sqrt(D a) {
#if defined(__AVX512F__)
  return {(DoubleVector)_mm512_maskz_sqrt_pd(kHalfLanes, (__m512d)a.lo),
          (DoubleVector)_mm512_maskz_sqrt_pd(kHalfLanes, (__m512d)a.hi)};
#elif defined(__AVX__)
  return {(DoubleVector)_mm256_sqrt_pd((__m256d)a.lo), (DoubleVector)_mm256_sqrt_pd((__m256d)a.hi)};
#else
  for (int i = 0; i < kHalf; ++i) {
    a.lo[i] = __builtin_sqrt(a.lo[i]);
    a.hi[i] = __builtin_sqrt(a.hi[i]);
  }
  return a;
#endif
}

LANCER_LANE F as_float(U a) { return F((FloatVector)a.v); }
LANCER_LANE U as_word(F a) { return U((WordVector)a.v); }
LANCER_LANE F abs(F a) { return as_float(as_word(a) & U(0x7fffffffu)); }
LANCER_LANE F copysign(F magnitude, F sign) {
  return as_float((as_word(magnitude) & U(0x7fffffffu)) | (as_word(sign) & U(0x80000000u)));
}
using LongWordVector = uint64_t __attribute__((vector_size(4 * kLanes)));
LANCER_LANE DoubleVector sign_and(DoubleVector a, uint64_t others) {
  return (DoubleVector)((LongWordVector)a & (others - LongWordVector{}));
}
LANCER_LANE D abs(D a) { return {sign_and(a.lo, ~(1ull << 63)), sign_and(a.hi, ~(1ull << 63))}; }
// 1 with the sign of a.
LANCER_LANE D sign(D a) {
  const LongWordVector one = (LongWordVector)(1.0 - DoubleVector{});
  return {(DoubleVector)((LongWordVector)sign_and(a.lo, 1ull << 63) | one),
          (DoubleVector)((LongWordVector)sign_and(a.hi, 1ull << 63) | one)};
}

// 2 to the power of a whole number within +-1022, as that of exponential.h.
LANCER_LANE D power_of_two(D whole) {
  const D digits = whole + D(0x1.8p52 + 1023.0);
  return {(DoubleVector)((LongWordVector)digits.lo << 52), (DoubleVector)((LongWordVector)digits.hi << 52)};
}

// Towards zero, of what an int32 holds; and back.
LANCER_LANE U truncate(F a) { return U((WordVector) __builtin_convertvector(a.v, IntVector)); }
LANCER_LANE F to_float(U a) { return F(__builtin_convertvector((IntVector)a.v, FloatVector)); }

// The largest whole number that is not above.
LANCER_LANE F floor(F a) {
#if defined(__AVX512F__)
  return F((FloatVector)_mm512_maskz_roundscale_ps(kAllLanes, (__m512)a.v, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
#elif defined(__AVX__)
  return F((FloatVector)_mm256_floor_ps((__m256)a.v));
#elif defined(__SSE4_1__)
  return F((FloatVector)_mm_floor_ps((__m128)a.v));
#else
  for (int i = 0; i < kLanes; ++i)
    a.v[i] = __builtin_floorf(a.v[i]);
  return a;
#endif
}

// Towards zero, of what an int32 holds.
LANCER_LANE U truncate(D a) {
#if defined(__AVX512F__)
  const __m256i lo = _mm512_maskz_cvttpd_epi32(kHalfLanes, (__m512d)a.lo);
  const __m256i hi = _mm512_maskz_cvttpd_epi32(kHalfLanes, (__m512d)a.hi);
  return U((WordVector)_mm512_maskz_inserti32x8(kAllLanes, _mm512_castsi256_si512(lo), hi, 1));
#else
  U r;
  for (int i = 0; i < kHalf; ++i) {
    r.v[i] = static_cast<uint32_t>(static_cast<int32_t>(a.lo[i]));
    r.v[i + kHalf] = static_cast<uint32_t>(static_cast<int32_t>(a.hi[i]));
  }
  return r;
#endif
}

// By intrinsics: GCC 12 takes a vector's conversion to floats and back for none at all.

} // namespace
} // namespace lancer
