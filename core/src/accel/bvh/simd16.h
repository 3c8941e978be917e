// Sixteen floats at a time: one ray a lane.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/simd.h"

namespace lancer {
namespace {

#if defined(__AVX512F__)

struct F16 {
  __m512 v;
};
LANCER_SIMD F16 load16(const float *p) { return {_mm512_load_ps(p)}; }
LANCER_SIMD F16 splat16(float x) { return {_mm512_set1_ps(x)}; }
LANCER_SIMD void store16(float *p, F16 a) { _mm512_store_ps(p, a.v); }
LANCER_SIMD F16 multiply_subtract(F16 a, F16 b, F16 c) { return {_mm512_fmsub_ps(a.v, b.v, c.v)}; }
// With a mask of all lanes: compilers warn of the undefined vector in the form without.
LANCER_SIMD F16 min16(F16 a, F16 b) { return {_mm512_maskz_min_ps(0xffff, a.v, b.v)}; }
// The second operand where one is undefined.
LANCER_SIMD F16 max16(F16 a, F16 b) { return {_mm512_maskz_max_ps(0xffff, a.v, b.v)}; }
LANCER_SIMD uint32_t less_equal(F16 a, F16 b) { return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ); }
// a where a <= b, undefined elsewhere.
LANCER_SIMD F16 drop_greater(F16 a, F16 b) {
  return {_mm512_mask_mov_ps(_mm512_set1_ps(__builtin_nanf("")), _mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ), a.v)};
}

struct D8 {
  __m512d v;
};
LANCER_SIMD D8 load8(const double *p) { return {_mm512_load_pd(p)}; }
LANCER_SIMD D8 splat8(double x) { return {_mm512_set1_pd(x)}; }
LANCER_SIMD D8 twice(D4 a) { return {_mm512_maskz_broadcast_f64x4(0xff, a.v)}; }
// Two of the numbers, four times each.
LANCER_SIMD D8 join(const double *p, const uint32_t at[2]) {
  return {_mm512_mask_mov_pd(_mm512_set1_pd(p[at[0]]), 0xf0, _mm512_set1_pd(p[at[1]]))};
}
LANCER_SIMD void store8(double *p, D8 a) { _mm512_store_pd(p, a.v); }
LANCER_SIMD D8 operator+(D8 a, D8 b) { return {_mm512_add_pd(a.v, b.v)}; }
LANCER_SIMD D8 operator-(D8 a, D8 b) { return {_mm512_sub_pd(a.v, b.v)}; }
LANCER_SIMD D8 operator*(D8 a, D8 b) { return {_mm512_mul_pd(a.v, b.v)}; }
LANCER_SIMD D8 operator/(D8 a, D8 b) { return {_mm512_div_pd(a.v, b.v)}; }
LANCER_SIMD D8 lower(D8 a, D8 b) { return {_mm512_maskz_min_pd(0xff, a.v, b.v)}; }
LANCER_SIMD D8 upper(D8 a, D8 b) { return {_mm512_maskz_max_pd(0xff, a.v, b.v)}; }
LANCER_SIMD uint32_t less_equal(D8 a, D8 b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_LE_OQ); }
LANCER_SIMD uint32_t less(D8 a, D8 b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ); }
LANCER_SIMD uint32_t not_equal(D8 a, D8 b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_NEQ_OQ); }

#else

struct F16 {
  F8 lo, hi;
};
LANCER_SIMD F16 load16(const float *p) { return {load8(p), load8(p + 8)}; }
LANCER_SIMD F16 splat16(float x) { return {splat8(x), splat8(x)}; }
LANCER_SIMD void store16(float *p, F16 a) {
  store8(p, a.lo);
  store8(p + 8, a.hi);
}
LANCER_SIMD F16 multiply_subtract(F16 a, F16 b, F16 c) {
  return {multiply_subtract(a.lo, b.lo, c.lo), multiply_subtract(a.hi, b.hi, c.hi)};
}
LANCER_SIMD F16 min16(F16 a, F16 b) { return {min8(a.lo, b.lo), min8(a.hi, b.hi)}; }
// The second operand where one is undefined.
LANCER_SIMD F16 max16(F16 a, F16 b) { return {max8(a.lo, b.lo), max8(a.hi, b.hi)}; }
LANCER_SIMD uint32_t less_equal(F16 a, F16 b) { return less_equal(a.lo, b.lo) | less_equal(a.hi, b.hi) << 8; }

// a where a <= b, undefined elsewhere.
LANCER_SIMD F8 drop_greater(F8 a, F8 b) {
#if defined(__AVX__)
  return {_mm256_or_ps(a.v, _mm256_cmp_ps(a.v, b.v, _CMP_NLE_UQ))};
#elif defined(__SSE4_1__)
  return {_mm_or_ps(a.lo, _mm_cmpnle_ps(a.lo, b.lo)), _mm_or_ps(a.hi, _mm_cmpnle_ps(a.hi, b.hi))};
#else
  return each(a, b, [](float x, float y) { return x <= y ? x : __builtin_nanf(""); });
#endif
}
struct D8 {
  D4 lo, hi;
};
LANCER_SIMD D8 load8(const double *p) { return {load4(p), load4(p + 4)}; }
LANCER_SIMD D8 splat8(double x) { return {splat4(x), splat4(x)}; }
LANCER_SIMD D8 twice(D4 a) { return {a, a}; }
// Two of the numbers, four times each.
LANCER_SIMD D8 join(const double *p, const uint32_t at[2]) { return {splat4(p[at[0]]), splat4(p[at[1]])}; }
LANCER_SIMD void store8(double *p, D8 a) {
  store4(p, a.lo);
  store4(p + 4, a.hi);
}
LANCER_SIMD D8 operator+(D8 a, D8 b) { return {a.lo + b.lo, a.hi + b.hi}; }
LANCER_SIMD D8 operator-(D8 a, D8 b) { return {a.lo - b.lo, a.hi - b.hi}; }
LANCER_SIMD D8 operator*(D8 a, D8 b) { return {a.lo * b.lo, a.hi * b.hi}; }
LANCER_SIMD D8 operator/(D8 a, D8 b) { return {a.lo / b.lo, a.hi / b.hi}; }
LANCER_SIMD D8 lower(D8 a, D8 b) { return {min4(a.lo, b.lo), min4(a.hi, b.hi)}; }
LANCER_SIMD D8 upper(D8 a, D8 b) { return {max4(a.lo, b.lo), max4(a.hi, b.hi)}; }
LANCER_SIMD uint32_t less_equal(D8 a, D8 b) { return less_equal(a.lo, b.lo) | less_equal(a.hi, b.hi) << 4; }
LANCER_SIMD uint32_t not_equal(D8 a, D8 b) { return not_equal(a.lo, b.lo) | not_equal(a.hi, b.hi) << 4; }
LANCER_SIMD uint32_t less(D8 a, D8 b) { return less_equal(a, b) & not_equal(a, b); }

LANCER_SIMD F16 drop_greater(F16 a, F16 b) { return {drop_greater(a.lo, b.lo), drop_greater(a.hi, b.hi)}; }

#endif

} // namespace
} // namespace lancer
