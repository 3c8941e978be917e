// Four by four doubles, rows for columns.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/simd.h"

namespace lancer {
namespace {

#if defined(__AVX__)
LANCER_SIMD void transpose4(D4 &a, D4 &b, D4 &c, D4 &d) {
  const __m256d ab0 = _mm256_unpacklo_pd(a.v, b.v), ab1 = _mm256_unpackhi_pd(a.v, b.v);
  const __m256d cd0 = _mm256_unpacklo_pd(c.v, d.v), cd1 = _mm256_unpackhi_pd(c.v, d.v);
  a.v = _mm256_permute2f128_pd(ab0, cd0, 0x20);
  b.v = _mm256_permute2f128_pd(ab1, cd1, 0x20);
  c.v = _mm256_permute2f128_pd(ab0, cd0, 0x31);
  d.v = _mm256_permute2f128_pd(ab1, cd1, 0x31);
}
#elif defined(__SSE4_1__)
LANCER_SIMD void transpose4(D4 &a, D4 &b, D4 &c, D4 &d) {
  const D4 x = {_mm_unpacklo_pd(a.lo, b.lo), _mm_unpacklo_pd(c.lo, d.lo)};
  const D4 y = {_mm_unpackhi_pd(a.lo, b.lo), _mm_unpackhi_pd(c.lo, d.lo)};
  const D4 z = {_mm_unpacklo_pd(a.hi, b.hi), _mm_unpacklo_pd(c.hi, d.hi)};
  const D4 w = {_mm_unpackhi_pd(a.hi, b.hi), _mm_unpackhi_pd(c.hi, d.hi)};
  a = x;
  b = y;
  c = z;
  d = w;
}
#else
LANCER_SIMD void transpose4(D4 &a, D4 &b, D4 &c, D4 &d) {
  const D4 rows[4] = {a, b, c, d};
  for (int i = 0; i < 4; ++i) {
    a.v[i] = rows[i].v[0];
    b.v[i] = rows[i].v[1];
    c.v[i] = rows[i].v[2];
    d.v[i] = rows[i].v[3];
  }
}
#endif

} // namespace
} // namespace lancer
