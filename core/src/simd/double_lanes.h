// Lanes of doubles, in two halves of W / 2, and their conversions. Internal linkage, as in lanes.h.
#pragma once

#include "simd/lanes.h"

namespace lancer {
namespace {

using lancer::widen;

template <int W> struct Double {
  using Vector = VectorOf<double, W / 2>;
  using Words = VectorOf<uint64_t, W / 2>;
  Vector lo, hi;
  Double() = default;
  LANCER_LANE Double(Vector a, Vector b) : lo(a), hi(b) {}
  LANCER_LANE Double(double x) : lo(x - Vector{}), hi(x - Vector{}) {}

  friend LANCER_LANE Double operator+(Double a, Double b) { return {a.lo + b.lo, a.hi + b.hi}; }
  friend LANCER_LANE Double operator-(Double a, Double b) { return {a.lo - b.lo, a.hi - b.hi}; }
  friend LANCER_LANE Double operator*(Double a, Double b) { return {a.lo * b.lo, a.hi * b.hi}; }
  friend LANCER_LANE Double operator/(Double a, Double b) { return {a.lo / b.lo, a.hi / b.hi}; }
  friend LANCER_LANE Double operator-(Double a) { return {-a.lo, -a.hi}; }
  LANCER_LANE Double &operator+=(Double b) { return *this = *this + b; }
  LANCER_LANE Double &operator-=(Double b) { return *this = *this - b; }
  LANCER_LANE Double &operator*=(Double b) { return *this = *this * b; }

#if defined(__AVX512F__)
#define LANCER_COMPARE(op, number)                                                                                             \
  friend LANCER_LANE Mask<W> operator op(Double a, Double b) {                                                                 \
    if constexpr (W == 16) {                                                                                                   \
      const uint32_t low = _mm512_cmp_pd_mask((__m512d)a.lo, (__m512d)b.lo, number);                                           \
      const uint32_t high = _mm512_cmp_pd_mask((__m512d)a.hi, (__m512d)b.hi, number);                                          \
      return {low | high << 8};                                                                                                \
    } else                                                                                                                     \
      return joined(a.lo op b.lo, a.hi op b.hi);                                                                               \
  }
#else
#define LANCER_COMPARE(op, number)                                                                                             \
  friend LANCER_LANE Mask<W> operator op(Double a, Double b) { return joined(a.lo op b.lo, a.hi op b.hi); }
#endif
  LANCER_COMPARE(<, _CMP_LT_OQ)
  LANCER_COMPARE(<=, _CMP_LE_OQ)
  LANCER_COMPARE(>, _CMP_GT_OQ)
  LANCER_COMPARE(>=, _CMP_GE_OQ)
  LANCER_COMPARE(==, _CMP_EQ_OQ)
  LANCER_COMPARE(!=, _CMP_NEQ_UQ)
#undef LANCER_COMPARE

  friend LANCER_LANE Double select(Mask<W> m, Double a, Double b) {
#if defined(__AVX2__)
    if constexpr (W == 8)
      return {(Vector)_mm256_blendv_pd((__m256d)b.lo, (__m256d)a.lo, (__m256d)low_half(m)),
              (Vector)_mm256_blendv_pd((__m256d)b.hi, (__m256d)a.hi, (__m256d)high_half(m))};
#endif
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return {(Vector)_mm512_mask_blend_pd(static_cast<__mmask8>(m.v), (__m512d)b.lo, (__m512d)a.lo),
              (Vector)_mm512_mask_blend_pd(static_cast<__mmask8>(m.v >> 8), (__m512d)b.hi, (__m512d)a.hi)};
    else
#endif
      return {low_half(m) ? a.lo : b.lo, high_half(m) ? a.hi : b.hi};
  }
  // Returns the first if they are equal or unordered.
  friend LANCER_LANE Double max(Double a, Double b) {
#if defined(__AVX__)
    if constexpr (W == 8)
      return {(Vector)_mm256_max_pd((__m256d)b.lo, (__m256d)a.lo), (Vector)_mm256_max_pd((__m256d)b.hi, (__m256d)a.hi)};
#elif defined(__SSE2__)
    if constexpr (W == 4)
      return {(Vector)_mm_max_pd((__m128d)b.lo, (__m128d)a.lo), (Vector)_mm_max_pd((__m128d)b.hi, (__m128d)a.hi)};
#endif
    return select(a < b, b, a);
  }
  friend LANCER_LANE Double min(Double a, Double b) {
#if defined(__AVX__)
    if constexpr (W == 8)
      return {(Vector)_mm256_min_pd((__m256d)b.lo, (__m256d)a.lo), (Vector)_mm256_min_pd((__m256d)b.hi, (__m256d)a.hi)};
#elif defined(__SSE2__)
    if constexpr (W == 4)
      return {(Vector)_mm_min_pd((__m128d)b.lo, (__m128d)a.lo), (Vector)_mm_min_pd((__m128d)b.hi, (__m128d)a.hi)};
#endif
    return select(b < a, b, a);
  }
  friend LANCER_LANE Double sqrt(Double a) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return {(Vector)_mm512_maskz_sqrt_pd(kHalfLanes, (__m512d)a.lo), (Vector)_mm512_maskz_sqrt_pd(kHalfLanes, (__m512d)a.hi)};
#endif
#if defined(__AVX__)
    if constexpr (W == 8)
      return {(Vector)_mm256_sqrt_pd((__m256d)a.lo), (Vector)_mm256_sqrt_pd((__m256d)a.hi)};
#elif defined(__SSE2__)
    if constexpr (W == 4)
      return {(Vector)_mm_sqrt_pd((__m128d)a.lo), (Vector)_mm_sqrt_pd((__m128d)a.hi)};
#endif
    for (int i = 0; i < W / 2; ++i) {
      a.lo[i] = __builtin_sqrt(a.lo[i]);
      a.hi[i] = __builtin_sqrt(a.hi[i]);
    }
    return a;
  }
  friend LANCER_LANE Double abs(Double a) { return {both(a.lo, ~(1ull << 63)), both(a.hi, ~(1ull << 63))}; }
  // Returns 1 with the sign of a.
  friend LANCER_LANE Double sign(Double a) {
    const Words one = (Words)(1.0 - Vector{});
    return {(Vector)((Words)both(a.lo, 1ull << 63) | one), (Vector)((Words)both(a.hi, 1ull << 63) | one)};
  }
  // Returns 2 to the power of a whole number within +-1022, see elementary.h.
  friend LANCER_LANE Double power_of_two(Double whole) {
    const Double digits = whole + Double(0x1.8p52 + 1023.0);
    return {(Vector)((Words)digits.lo << 52), (Vector)((Words)digits.hi << 52)};
  }
  friend LANCER_LANE Float<W> narrow(Double a) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Float<W>((VectorOf<float, W>)_mm512_maskz_insertf32x8(
          kAllLanes, _mm512_castps256_ps512(_mm512_maskz_cvtpd_ps(kHalfLanes, (__m512d)a.lo)),
          _mm512_maskz_cvtpd_ps(kHalfLanes, (__m512d)a.hi), 1));
#endif
#if defined(__AVX__)
    if constexpr (W == 8)
      return Float<W>((VectorOf<float, W>)_mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps((__m256d)a.lo)),
                                                               _mm256_cvtpd_ps((__m256d)a.hi), 1));
#endif
#if defined(__SSE2__)
    if constexpr (W == 4)
      return Float<W>((VectorOf<float, W>)_mm_movelh_ps(_mm_cvtpd_ps((__m128d)a.lo), _mm_cvtpd_ps((__m128d)a.hi)));
#endif
    Float<W> r;
    for (int i = 0; i < W / 2; ++i) {
      r.v[i] = static_cast<float>(a.lo[i]);
      r.v[i + W / 2] = static_cast<float>(a.hi[i]);
    }
    return r;
  }
  // Rounds towards zero; the value must fit an int32.
  friend LANCER_LANE Word<W> truncate(Double a) {
#if defined(__AVX512F__)
    if constexpr (W == 16) {
      // By intrinsics: GCC 12 drops a vector's conversion to floats and back.
      const __m256i low = _mm512_maskz_cvttpd_epi32(kHalfLanes, (__m512d)a.lo);
      const __m256i high = _mm512_maskz_cvttpd_epi32(kHalfLanes, (__m512d)a.hi);
      return Word<W>((VectorOf<uint32_t, W>)_mm512_maskz_inserti32x8(kAllLanes, _mm512_castsi256_si512(low), high, 1));
    }
#endif
#if defined(__AVX__)
    if constexpr (W == 8)
      return Word<W>((VectorOf<uint32_t, W>)_mm256_insertf128_si256(_mm256_castsi128_si256(_mm256_cvttpd_epi32((__m256d)a.lo)),
                                                                    _mm256_cvttpd_epi32((__m256d)a.hi), 1));
#endif
    Word<W> r;
    for (int i = 0; i < W / 2; ++i) {
      r.v[i] = static_cast<uint32_t>(static_cast<int32_t>(a.lo[i]));
      r.v[i + W / 2] = static_cast<uint32_t>(static_cast<int32_t>(a.hi[i]));
    }
    return r;
  }

private:
  static LANCER_LANE Mask<W> joined(VectorOf<int64_t, W / 2> low, VectorOf<int64_t, W / 2> high) {
    return {narrow_halves<W>(low, high, std::make_integer_sequence<int, W>())};
  }
  static LANCER_LANE Vector both(Vector a, uint64_t others) { return (Vector)((Words)a & (others - Words{})); }
};

template <int W, class Function> LANCER_LANE Double<W> each(Double<W> a, const Function &f) {
  alignas(64) double of[W];
  __builtin_memcpy(of, &a, sizeof(of));
  for (double &x : of)
    x = f(x);
  Double<W> r;
  __builtin_memcpy(&r, of, sizeof(of));
  return r;
}
template <int W> LANCER_LANE Double<W> widen(Float<W> a) {
  using Vector = VectorOf<double, W / 2>;
#if defined(__AVX512F__)
  if constexpr (W == 16) {
    const __m512 v = (__m512)a.v;
    return {(Vector)_mm512_maskz_cvtps_pd(kHalfLanes, _mm512_maskz_extractf32x8_ps(kHalfLanes, v, 0)),
            (Vector)_mm512_maskz_cvtps_pd(kHalfLanes, _mm512_maskz_extractf32x8_ps(kHalfLanes, v, 1))};
  }
#endif
#if defined(__AVX__)
  if constexpr (W == 8) {
    const __m256 v = (__m256)a.v;
    return {(Vector)_mm256_cvtps_pd(_mm256_castps256_ps128(v)), (Vector)_mm256_cvtps_pd(_mm256_extractf128_ps(v, 1))};
  }
#endif
#if defined(__SSE2__)
  if constexpr (W == 4) {
    const __m128 v = (__m128)a.v;
    return {(Vector)_mm_cvtps_pd(v), (Vector)_mm_cvtps_pd(_mm_movehl_ps(v, v))};
  }
#endif
  Double<W> r;
  for (int i = 0; i < W / 2; ++i) {
    r.lo[i] = static_cast<double>(a.v[i]);
    r.hi[i] = static_cast<double>(a.v[i + W / 2]);
  }
  return r;
}

} // namespace

template <int W> struct LanesOf<Float<W>> {
  static constexpr int kWidth = W;
  using Double = lancer::Double<W>;
  using Word = lancer::Word<W>;
  using Mask = lancer::Mask<W>;
  static LANCER_LANE Mask uniform(bool m) { return mask_from<W>(m ? (1u << W) - 1u : 0u); }
};

} // namespace lancer
