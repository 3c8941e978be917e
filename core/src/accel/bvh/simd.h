// Eight floats and four doubles at a time, in the instruction set that this translation unit is compiled for.
// For bvh_kernel.cpp only: everything has internal linkage, so that no other unit can pick up this unit's instructions.
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace lancer {
namespace {

#define LANCER_SIMD [[gnu::always_inline]] inline

#if defined(__AVX__)

struct F8 {
  __m256 v;
};
LANCER_SIMD F8 load8(const float *p) { return {_mm256_load_ps(p)}; }
LANCER_SIMD F8 splat8(float x) { return {_mm256_set1_ps(x)}; }
LANCER_SIMD F8 load8_anywhere(const float *p) { return {_mm256_loadu_ps(p)}; }
LANCER_SIMD void store8(float *p, F8 a) { _mm256_store_ps(p, a.v); }
LANCER_SIMD F8 operator-(F8 a, F8 b) { return {_mm256_sub_ps(a.v, b.v)}; }
LANCER_SIMD F8 operator*(F8 a, F8 b) { return {_mm256_mul_ps(a.v, b.v)}; }
#if defined(__FMA__)
LANCER_SIMD F8 multiply_subtract(F8 a, F8 b, F8 c) { return {_mm256_fmsub_ps(a.v, b.v, c.v)}; }
#else
LANCER_SIMD F8 multiply_subtract(F8 a, F8 b, F8 c) { return a * b - c; }
#endif
LANCER_SIMD F8 min8(F8 a, F8 b) { return {_mm256_min_ps(a.v, b.v)}; }
LANCER_SIMD F8 max8(F8 a, F8 b) { return {_mm256_max_ps(a.v, b.v)}; }
LANCER_SIMD uint32_t less_equal(F8 a, F8 b) {
  return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}

#if defined(__AVX512VL__)
#define LANCER_HAS_COMPRESS
// Writes the lanes of mask, close together. Up to eight lanes behind them may be overwritten.
LANCER_SIMD void compress8(float *entries, uint32_t *children, F8 entry, const uint32_t *child, uint32_t mask) {
  const __mmask8 m = static_cast<__mmask8>(mask);
  _mm256_storeu_ps(entries, _mm256_maskz_compress_ps(m, entry.v));
  _mm256_storeu_si256(reinterpret_cast<__m256i *>(children),
                      _mm256_maskz_compress_epi32(m, _mm256_loadu_si256(reinterpret_cast<const __m256i *>(child))));
}
// The same with the lanes in another order, three bits each, the first in the lowest; mask is of the old order.
LANCER_SIMD uint32_t compress_ordered8(float *entries, uint32_t *children, F8 entry, F8 exit, const uint32_t *child,
                                       uint32_t order) {
  const __m256i lanes =
      _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(order)), _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21));
  const __m256 e = _mm256_permutevar8x32_ps(entry.v, lanes), x = _mm256_permutevar8x32_ps(exit.v, lanes);
  const __m256i c = _mm256_permutevar8x32_epi32(_mm256_load_si256(reinterpret_cast<const __m256i *>(child)), lanes);
  const __mmask8 m = _mm256_cmp_ps_mask(e, x, _CMP_LE_OQ);
  _mm256_storeu_ps(entries, _mm256_maskz_compress_ps(m, e));
  _mm256_storeu_si256(reinterpret_cast<__m256i *>(children), _mm256_maskz_compress_epi32(m, c));
  return static_cast<uint32_t>(__builtin_popcount(m));
}
#endif

struct D4 {
  __m256d v;
};
LANCER_SIMD D4 widen4(const float *p) { return {_mm256_cvtps_pd(_mm_load_ps(p))}; }
LANCER_SIMD D4 splat4(double x) { return {_mm256_set1_pd(x)}; }
LANCER_SIMD D4 load4(const double *p) { return {_mm256_load_pd(p)}; }
LANCER_SIMD D4 load4_anywhere(const double *p) { return {_mm256_loadu_pd(p)}; }
LANCER_SIMD void store4(double *p, D4 a) { _mm256_store_pd(p, a.v); }
LANCER_SIMD D4 operator+(D4 a, D4 b) { return {_mm256_add_pd(a.v, b.v)}; }
LANCER_SIMD D4 operator-(D4 a, D4 b) { return {_mm256_sub_pd(a.v, b.v)}; }
LANCER_SIMD D4 operator*(D4 a, D4 b) { return {_mm256_mul_pd(a.v, b.v)}; }
LANCER_SIMD D4 operator/(D4 a, D4 b) { return {_mm256_div_pd(a.v, b.v)}; }
LANCER_SIMD D4 min4(D4 a, D4 b) { return {_mm256_min_pd(a.v, b.v)}; }
LANCER_SIMD D4 max4(D4 a, D4 b) { return {_mm256_max_pd(a.v, b.v)}; }
LANCER_SIMD D4 root4(D4 a) { return {_mm256_sqrt_pd(a.v)}; }
LANCER_SIMD D4 magnitude4(D4 a) { return {_mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v)}; }
// power_of_two() of object_ray.h.
LANCER_SIMD void power_of_two4(D4 a, D4 &power, D4 &inverse) {
  const __m256i bits = _mm256_and_si256(_mm256_castpd_si256(a.v), _mm256_set1_epi64x(0x7ffll << 52));
  power.v = _mm256_castsi256_pd(bits);
  inverse.v = _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_set1_epi64x(2046ll << 52), bits));
}
LANCER_SIMD uint32_t less_equal(D4 a, D4 b) {
  return static_cast<uint32_t>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_LE_OQ)));
}
LANCER_SIMD uint32_t not_equal(D4 a, D4 b) {
  return static_cast<uint32_t>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_NEQ_OQ)));
}

#elif defined(__SSE4_1__)

struct F8 {
  __m128 lo, hi;
};
LANCER_SIMD F8 load8(const float *p) { return {_mm_load_ps(p), _mm_load_ps(p + 4)}; }
LANCER_SIMD F8 splat8(float x) { return {_mm_set1_ps(x), _mm_set1_ps(x)}; }
LANCER_SIMD F8 load8_anywhere(const float *p) { return {_mm_loadu_ps(p), _mm_loadu_ps(p + 4)}; }
LANCER_SIMD void store8(float *p, F8 a) {
  _mm_store_ps(p, a.lo);
  _mm_store_ps(p + 4, a.hi);
}
LANCER_SIMD F8 operator-(F8 a, F8 b) { return {_mm_sub_ps(a.lo, b.lo), _mm_sub_ps(a.hi, b.hi)}; }
LANCER_SIMD F8 operator*(F8 a, F8 b) { return {_mm_mul_ps(a.lo, b.lo), _mm_mul_ps(a.hi, b.hi)}; }
LANCER_SIMD F8 multiply_subtract(F8 a, F8 b, F8 c) { return a * b - c; }
LANCER_SIMD F8 min8(F8 a, F8 b) { return {_mm_min_ps(a.lo, b.lo), _mm_min_ps(a.hi, b.hi)}; }
LANCER_SIMD F8 max8(F8 a, F8 b) { return {_mm_max_ps(a.lo, b.lo), _mm_max_ps(a.hi, b.hi)}; }
LANCER_SIMD uint32_t less_equal(F8 a, F8 b) {
  return static_cast<uint32_t>(_mm_movemask_ps(_mm_cmple_ps(a.lo, b.lo)) | _mm_movemask_ps(_mm_cmple_ps(a.hi, b.hi)) << 4);
}

struct D4 {
  __m128d lo, hi;
};
LANCER_SIMD D4 widen4(const float *p) {
  const __m128 v = _mm_load_ps(p);
  return {_mm_cvtps_pd(v), _mm_cvtps_pd(_mm_movehl_ps(v, v))};
}
LANCER_SIMD D4 splat4(double x) { return {_mm_set1_pd(x), _mm_set1_pd(x)}; }
LANCER_SIMD D4 load4(const double *p) { return {_mm_load_pd(p), _mm_load_pd(p + 2)}; }
LANCER_SIMD D4 load4_anywhere(const double *p) { return {_mm_loadu_pd(p), _mm_loadu_pd(p + 2)}; }
LANCER_SIMD void store4(double *p, D4 a) {
  _mm_store_pd(p, a.lo);
  _mm_store_pd(p + 2, a.hi);
}
LANCER_SIMD D4 operator+(D4 a, D4 b) { return {_mm_add_pd(a.lo, b.lo), _mm_add_pd(a.hi, b.hi)}; }
LANCER_SIMD D4 operator-(D4 a, D4 b) { return {_mm_sub_pd(a.lo, b.lo), _mm_sub_pd(a.hi, b.hi)}; }
LANCER_SIMD D4 operator*(D4 a, D4 b) { return {_mm_mul_pd(a.lo, b.lo), _mm_mul_pd(a.hi, b.hi)}; }
LANCER_SIMD D4 operator/(D4 a, D4 b) { return {_mm_div_pd(a.lo, b.lo), _mm_div_pd(a.hi, b.hi)}; }
LANCER_SIMD D4 min4(D4 a, D4 b) { return {_mm_min_pd(a.lo, b.lo), _mm_min_pd(a.hi, b.hi)}; }
LANCER_SIMD D4 max4(D4 a, D4 b) { return {_mm_max_pd(a.lo, b.lo), _mm_max_pd(a.hi, b.hi)}; }
LANCER_SIMD D4 root4(D4 a) { return {_mm_sqrt_pd(a.lo), _mm_sqrt_pd(a.hi)}; }
LANCER_SIMD D4 magnitude4(D4 a) {
  const __m128d sign = _mm_set1_pd(-0.0);
  return {_mm_andnot_pd(sign, a.lo), _mm_andnot_pd(sign, a.hi)};
}
// power_of_two() of object_ray.h.
LANCER_SIMD void power_of_two4(D4 a, D4 &power, D4 &inverse) {
  const __m128i exponent = _mm_set1_epi64x(0x7ffll << 52), most = _mm_set1_epi64x(2046ll << 52);
  const __m128i lo = _mm_and_si128(_mm_castpd_si128(a.lo), exponent), hi = _mm_and_si128(_mm_castpd_si128(a.hi), exponent);
  power = {_mm_castsi128_pd(lo), _mm_castsi128_pd(hi)};
  inverse = {_mm_castsi128_pd(_mm_sub_epi64(most, lo)), _mm_castsi128_pd(_mm_sub_epi64(most, hi))};
}
LANCER_SIMD uint32_t less_equal(D4 a, D4 b) {
  return static_cast<uint32_t>(_mm_movemask_pd(_mm_cmple_pd(a.lo, b.lo)) | _mm_movemask_pd(_mm_cmple_pd(a.hi, b.hi)) << 2);
}
LANCER_SIMD uint32_t not_equal(D4 a, D4 b) {
  const __m128d lo = _mm_and_pd(_mm_cmpneq_pd(a.lo, b.lo), _mm_cmpord_pd(a.lo, b.lo));
  const __m128d hi = _mm_and_pd(_mm_cmpneq_pd(a.hi, b.hi), _mm_cmpord_pd(a.hi, b.hi));
  return static_cast<uint32_t>(_mm_movemask_pd(lo) | _mm_movemask_pd(hi) << 2);
}

#else

// Plain lanes, which the compiler turns into NEON and its kin.
template <class T, int N> struct Lanes { T v[N]; };
using F8 = Lanes<float, 8>;
using D4 = Lanes<double, 4>;

template <class T, int N, class Op> LANCER_SIMD Lanes<T, N> each(Lanes<T, N> a, Lanes<T, N> b, Op op) {
  Lanes<T, N> r;
  for (int i = 0; i < N; ++i)
    r.v[i] = op(a.v[i], b.v[i]);
  return r;
}
template <class T, int N, class Op> LANCER_SIMD uint32_t mask(Lanes<T, N> a, Lanes<T, N> b, Op op) {
  uint32_t r = 0;
  for (int i = 0; i < N; ++i)
    r |= static_cast<uint32_t>(op(a.v[i], b.v[i])) << i;
  return r;
}
#define LANCER_LANES(name, expression)                                                                                         \
  template <class T, int N> LANCER_SIMD Lanes<T, N> name(Lanes<T, N> a, Lanes<T, N> b) {                                       \
    return each(a, b, [](T x, T y) { return expression; });                                                                    \
  }
LANCER_LANES(operator+, x + y)
LANCER_LANES(operator-, x - y)
LANCER_LANES(operator*, x *y)
LANCER_LANES(operator/, x / y)
LANCER_LANES(min8, x < y ? x : y)
LANCER_LANES(max8, x > y ? x : y)
LANCER_LANES(min4, x < y ? x : y)
LANCER_LANES(max4, x > y ? x : y)
#undef LANCER_LANES
template <class T, int N> LANCER_SIMD uint32_t less_equal(Lanes<T, N> a, Lanes<T, N> b) {
  return mask(a, b, [](T x, T y) { return x <= y; });
}
template <class T, int N> LANCER_SIMD uint32_t not_equal(Lanes<T, N> a, Lanes<T, N> b) {
  return mask(a, b, [](T x, T y) { return x < y || x > y; });
}
template <class T, int N> LANCER_SIMD Lanes<T, N> splat(T x) {
  Lanes<T, N> r;
  for (T &lane : r.v)
    lane = x;
  return r;
}
LANCER_SIMD F8 splat8(float x) { return splat<float, 8>(x); }
LANCER_SIMD D4 splat4(double x) { return splat<double, 4>(x); }
LANCER_SIMD D4 load4(const double *p) { return {p[0], p[1], p[2], p[3]}; }
LANCER_SIMD D4 load4_anywhere(const double *p) { return load4(p); }
LANCER_SIMD F8 load8(const float *p) {
  F8 r;
  for (int i = 0; i < 8; ++i)
    r.v[i] = p[i];
  return r;
}
LANCER_SIMD F8 load8_anywhere(const float *p) { return load8(p); }
template <class T, int N> LANCER_SIMD Lanes<T, N> multiply_subtract(Lanes<T, N> a, Lanes<T, N> b, Lanes<T, N> c) {
  return a * b - c;
}
LANCER_SIMD D4 widen4(const float *p) {
  D4 r;
  for (int i = 0; i < 4; ++i)
    r.v[i] = static_cast<double>(p[i]);
  return r;
}
LANCER_SIMD D4 root4(D4 a) {
  for (double &lane : a.v)
    lane = __builtin_sqrt(lane);
  return a;
}
LANCER_SIMD D4 magnitude4(D4 a) {
  for (double &lane : a.v)
    lane = __builtin_fabs(lane);
  return a;
}
// power_of_two() of object_ray.h.
LANCER_SIMD void power_of_two4(D4 a, D4 &power, D4 &inverse) {
  for (int i = 0; i < 4; ++i) {
    const uint64_t bits = __builtin_bit_cast(uint64_t, a.v[i]) & 0x7ffull << 52;
    power.v[i] = __builtin_bit_cast(double, bits);
    inverse.v[i] = __builtin_bit_cast(double, (2046ull << 52) - bits);
  }
}
LANCER_SIMD void store8(float *p, F8 a) {
  for (int i = 0; i < 8; ++i)
    p[i] = a.v[i];
}
LANCER_SIMD void store4(double *p, D4 a) {
  for (int i = 0; i < 4; ++i)
    p[i] = a.v[i];
}

#endif

#if !defined(LANCER_HAS_COMPRESS)
// Writes the lanes of mask, close together. Up to eight lanes behind them may be overwritten.
LANCER_SIMD void compress8(float *entries, uint32_t *children, F8 entry, const uint32_t *child, uint32_t mask) {
  alignas(32) float e[8];
  uint32_t c[8];
  store8(e, entry);
  for (int i = 0; i < 8; ++i)
    c[i] = child[i];
  uint32_t count = 0;
  for (uint32_t i = 0; i < 8; ++i) {
    entries[count] = e[i];
    children[count] = c[i];
    count += mask >> i & 1;
  }
}
// The lanes with entry <= exit in another order: three bits each, the first in the lowest. Returns their number.
LANCER_SIMD uint32_t compress_ordered8(float *entries, uint32_t *children, F8 entry, F8 exit, const uint32_t *child,
                                       uint32_t order) {
  alignas(32) float e[8];
  store8(e, entry);
  const uint32_t mask = less_equal(entry, exit);
  uint32_t count = 0;
  for (uint32_t i = 0; i < 8; ++i, order >>= 3) {
    const uint32_t lane = order & 7;
    entries[count] = e[lane];
    children[count] = child[lane];
    count += mask >> lane & 1;
  }
  return count;
}
#endif

} // namespace
} // namespace lancer
