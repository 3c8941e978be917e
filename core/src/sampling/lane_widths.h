// Lanes of floats as doubles and back, rounded as IEEE 754 has it. For kernels only, like lanes.h.
#pragma once

#include "sampling/lanes.h"

namespace lancer {
namespace {

LANCER_LANE D widen(F a) {
#if defined(__AVX512F__)
  const __m512 v = (__m512)a.v;
  return {(DoubleVector)_mm512_maskz_cvtps_pd(kHalfLanes, _mm512_maskz_extractf32x8_ps(kHalfLanes, v, 0)),
          (DoubleVector)_mm512_maskz_cvtps_pd(kHalfLanes, _mm512_maskz_extractf32x8_ps(kHalfLanes, v, 1))};
#elif defined(__AVX__)
  const __m256 v = (__m256)a.v;
  return {(DoubleVector)_mm256_cvtps_pd(_mm256_castps256_ps128(v)), (DoubleVector)_mm256_cvtps_pd(_mm256_extractf128_ps(v, 1))};
#elif defined(__SSE2__)
  const __m128 v = (__m128)a.v;
  return {(DoubleVector)_mm_cvtps_pd(v), (DoubleVector)_mm_cvtps_pd(_mm_movehl_ps(v, v))};
#else
  D r;
  for (int i = 0; i < kHalf; ++i) {
    r.lo[i] = static_cast<double>(a.v[i]);
    r.hi[i] = static_cast<double>(a.v[i + kHalf]);
  }
  return r;
#endif
}
LANCER_LANE F narrow(D a) {
#if defined(__AVX512F__)
  return F((FloatVector)_mm512_maskz_insertf32x8(kAllLanes,
                                                 _mm512_castps256_ps512(_mm512_maskz_cvtpd_ps(kHalfLanes, (__m512d)a.lo)),
                                                 _mm512_maskz_cvtpd_ps(kHalfLanes, (__m512d)a.hi), 1));
#elif defined(__AVX__)
  return F((FloatVector)_mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps((__m256d)a.lo)),
                                             _mm256_cvtpd_ps((__m256d)a.hi), 1));
#elif defined(__SSE2__)
  return F((FloatVector)_mm_movelh_ps(_mm_cvtpd_ps((__m128d)a.lo), _mm_cvtpd_ps((__m128d)a.hi)));
#else
  F r;
  for (int i = 0; i < kHalf; ++i) {
    r.v[i] = static_cast<float>(a.lo[i]);
    r.v[i + kHalf] = static_cast<float>(a.hi[i]);
  }
  return r;
#endif
}

} // namespace
} // namespace lancer
