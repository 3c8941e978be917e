// As many doubles as fit in one register, four with AVX and eight with AVX-512, without the two halves of double_lanes.h; and
// operations of kernels on four or eight doubles, in either representation. Internal linkage, as in lanes.h.
#pragma once

#include "simd/memory.h"

namespace lancer {
namespace {

#if defined(__AVX512F__)
constexpr int kRegisterDoubles = 8;
#elif defined(__AVX__)
constexpr int kRegisterDoubles = 4;
#else
constexpr int kRegisterDoubles = 2;
#endif
template <int W>
concept OneRegister = W >= 4 && W <= kRegisterDoubles;

// Conditions of such doubles, one bit per lane.
template <int W> struct LaneBits {
  uint32_t v;

  friend LANCER_LANE LaneBits operator&(LaneBits a, LaneBits b) { return {a.v & b.v}; }
  friend LANCER_LANE LaneBits operator|(LaneBits a, LaneBits b) { return {a.v | b.v}; }
};
template <int W> LANCER_LANE uint32_t bits(LaneBits<W> m) { return m.v; }

#if defined(__AVX__)
template <int W>
requires OneRegister<W>
struct Double<W> {
  using Vector = VectorOf<double, W>;
  using Words = VectorOf<uint64_t, W>;
  Vector v;
  Double() = default;
  LANCER_LANE Double(Vector x) : v(x) {}
  LANCER_LANE Double(double x) : v(x - Vector{}) {}

  friend LANCER_LANE Double operator+(Double a, Double b) { return a.v + b.v; }
  friend LANCER_LANE Double operator-(Double a, Double b) { return a.v - b.v; }
  friend LANCER_LANE Double operator*(Double a, Double b) { return a.v * b.v; }
  friend LANCER_LANE Double operator/(Double a, Double b) { return a.v / b.v; }
  friend LANCER_LANE Double operator-(Double a) { return -a.v; }

#if defined(__AVX512F__)
#define LANCER_COMPARE(op, number)                                                                                             \
  friend LANCER_LANE LaneBits<W> operator op(Double a, Double b) {                                                             \
    if constexpr (W == 8)                                                                                                      \
      return {_mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, number)};                                                         \
    else                                                                                                                       \
      return {static_cast<uint32_t>(_mm256_movemask_pd(_mm256_cmp_pd((__m256d)a.v, (__m256d)b.v, number)))};                   \
  }
#else
#define LANCER_COMPARE(op, number)                                                                                             \
  friend LANCER_LANE LaneBits<W> operator op(Double a, Double b) {                                                             \
    return {static_cast<uint32_t>(_mm256_movemask_pd(_mm256_cmp_pd((__m256d)a.v, (__m256d)b.v, number)))};                     \
  }
#endif
  LANCER_COMPARE(<, _CMP_LT_OQ)
  LANCER_COMPARE(<=, _CMP_LE_OQ)
  LANCER_COMPARE(>, _CMP_GT_OQ)
  LANCER_COMPARE(>=, _CMP_GE_OQ)
  LANCER_COMPARE(==, _CMP_EQ_OQ)
#undef LANCER_COMPARE

  // Returns the first if they are equal or unordered.
  friend LANCER_LANE Double max(Double a, Double b) {
#if defined(__AVX512F__)
    if constexpr (W == 8)
      return (Vector)_mm512_maskz_max_pd(kHalfLanes, (__m512d)b.v, (__m512d)a.v);
    else
#endif
      return (Vector)_mm256_max_pd((__m256d)b.v, (__m256d)a.v);
  }
  friend LANCER_LANE Double min(Double a, Double b) {
#if defined(__AVX512F__)
    if constexpr (W == 8)
      return (Vector)_mm512_maskz_min_pd(kHalfLanes, (__m512d)b.v, (__m512d)a.v);
    else
#endif
      return (Vector)_mm256_min_pd((__m256d)b.v, (__m256d)a.v);
  }
  friend LANCER_LANE Double sqrt(Double a) {
#if defined(__AVX512F__)
    if constexpr (W == 8)
      return (Vector)_mm512_maskz_sqrt_pd(kHalfLanes, (__m512d)a.v);
    else
#endif
      return (Vector)_mm256_sqrt_pd((__m256d)a.v);
  }
  friend LANCER_LANE Double abs(Double a) { return (Vector)((Words)a.v & (~(1ull << 63) - Words{})); }
};
#endif

// Loads from arrays aligned to the lanes, or from any address.
template <int W> LANCER_LANE auto load_doubles(const double *p) {
  if constexpr (OneRegister<W>)
    return Double<W>(*reinterpret_cast<const VectorOf<double, W> *>(p));
  else
    return load_lanes<W>(p);
}
template <int W> LANCER_LANE Double<W> load_anywhere(const double *p) {
  Double<W> r;
  __builtin_memcpy(&r, p, sizeof(r));
  return r;
}
template <int W>
requires OneRegister<W> LANCER_LANE void store(double *p, Double<W> a) { *reinterpret_cast<VectorOf<double, W> *>(p) = a.v; }

// Loads four floats as doubles.
LANCER_LANE Double<4> load_widened(const float *p) {
#if defined(__AVX__)
  return (VectorOf<double, 4>)_mm256_cvtps_pd(_mm_load_ps(p));
#else
  return widen(load_lanes<4>(p));
#endif
}

// Loads Count numbers and repeats each four times.
template <int Count> LANCER_LANE Double<4 * Count> four_of_each(const double *p, const uint32_t (&at)[Count]) {
  static_assert(Count <= 2);
  if constexpr (Count == 1)
    return Double<4>(p[at[0]]);
#if defined(__AVX512F__)
  else
    return (VectorOf<double, 8>)_mm512_mask_mov_pd(_mm512_set1_pd(p[at[0]]), 0xf0, _mm512_set1_pd(p[at[1]]));
#else
  else
    return {p[at[0]] - VectorOf<double, 4>{}, p[at[1]] - VectorOf<double, 4>{}};
#endif
}
// Repeats four doubles Count times.
template <int Count> LANCER_LANE Double<4 * Count> repeat(Double<4> a) {
  static_assert(Count <= 2);
  if constexpr (Count == 1)
    return a;
#if defined(__AVX512F__)
  else
    return (VectorOf<double, 8>)_mm512_maskz_broadcast_f64x4(kHalfLanes, (__m256d)a.v);
#elif defined(__AVX__)
  else
    return {a.v, a.v};
#else
  else
    return {__builtin_shufflevector(a.lo, a.hi, 0, 1, 2, 3), __builtin_shufflevector(a.lo, a.hi, 0, 1, 2, 3)};
#endif
}

// Transposes four by four doubles.
LANCER_LANE void transpose(Double<4> &a, Double<4> &b, Double<4> &c, Double<4> &d) {
#if defined(__AVX__)
  using Vector = VectorOf<double, 4>;
  const Vector ab0 = __builtin_shufflevector(a.v, b.v, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a.v, b.v, 1, 5, 3, 7);
  const Vector cd0 = __builtin_shufflevector(c.v, d.v, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c.v, d.v, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
#else
  const Double<4> rows[4] = {a, b, c, d};
  const auto low = [](auto x, auto y) { return __builtin_shufflevector(x, y, 0, 2); };
  const auto high = [](auto x, auto y) { return __builtin_shufflevector(x, y, 1, 3); };
  a = {low(rows[0].lo, rows[1].lo), low(rows[2].lo, rows[3].lo)};
  b = {high(rows[0].lo, rows[1].lo), high(rows[2].lo, rows[3].lo)};
  c = {low(rows[0].hi, rows[1].hi), low(rows[2].hi, rows[3].hi)};
  d = {high(rows[0].hi, rows[1].hi), high(rows[2].hi, rows[3].hi)};
#endif
}

// Returns b shifted by a number of lanes towards the last one, the last lanes of a moved in before it.
template <int By, class Vector> LANCER_LANE Vector shifted_in(Vector a, Vector b) {
  constexpr int W = sizeof(Vector) / sizeof(double);
  if constexpr (W == 8)
    return __builtin_shufflevector(a, b, 8 - By, 9 - By, 10 - By, 11 - By, 12 - By, 13 - By, 14 - By, 15 - By);
  else if constexpr (W == 4)
    return __builtin_shufflevector(a, b, 4 - By, 5 - By, 6 - By, 7 - By);
  else
    return __builtin_shufflevector(a, b, 2 - By, 3 - By);
}

} // namespace
} // namespace lancer
