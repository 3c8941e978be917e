// Lanes from memory and back: from arrays, or each from a place of its own. For kernels only, like lanes.h.
#pragma once

#include "sampling/lanes.h"

namespace lancer {
namespace {

// Of arrays aligned to 64 bytes.
LANCER_LANE F load(const float *p) { return F(*reinterpret_cast<const FloatVector *>(p)); }
LANCER_LANE U load(const uint32_t *p) { return U(*reinterpret_cast<const WordVector *>(p)); }
LANCER_LANE D load(const double *p) {
  return {*reinterpret_cast<const DoubleVector *>(p), *reinterpret_cast<const DoubleVector *>(p + kHalf)};
}
LANCER_LANE void store(float *p, F a) { *reinterpret_cast<FloatVector *>(p) = a.v; }
LANCER_LANE void store(uint32_t *p, U a) { *reinterpret_cast<WordVector *>(p) = a.v; }
LANCER_LANE void store(double *p, D a) {
  *reinterpret_cast<DoubleVector *>(p) = a.lo;
  *reinterpret_cast<DoubleVector *>(p + kHalf) = a.hi;
}
// Only the lanes of m.
LANCER_LANE void store(float *p, M m, F a) { store(p, select(m, a, load(p))); }
LANCER_LANE void store(double *p, M m, D a) { store(p, select(m, a, load(p))); }

// Whether all lanes read the same place.
template <class T> LANCER_LANE bool all_same(const T *const *of) {
  bool same = true;
  for (int i = 1; i < kLanes; ++i)
    same = same && of[i] == of[0];
  return same;
}

LANCER_LANE F gather(const float *table, U index) {
#if defined(__AVX512F__)
  return F((FloatVector)_mm512_mask_i32gather_ps(_mm512_setzero_ps(), kAllLanes, (__m512i)index.v, table, 4));
#else
  F r;
  for (int i = 0; i < kLanes; ++i)
    r.v[i] = table[index.v[i]];
  return r;
#endif
}
LANCER_LANE U gather(const uint32_t *table, U index) {
#if defined(__AVX512F__)
  return U((WordVector)_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), kAllLanes, (__m512i)index.v, table, 4));
#else
  U r;
  for (int i = 0; i < kLanes; ++i)
    r.v[i] = table[index.v[i]];
  return r;
#endif
}
LANCER_LANE D gather(const double *table, U index) {
#if defined(__AVX512F__)
  const __m512i all = (__m512i)index.v;
  const __m256i lo = _mm512_maskz_extracti32x8_epi32(kHalfLanes, all, 0),
                hi = _mm512_maskz_extracti32x8_epi32(kHalfLanes, all, 1);
  return {(DoubleVector)_mm512_mask_i32gather_pd(_mm512_setzero_pd(), kHalfLanes, lo, table, 8),
          (DoubleVector)_mm512_mask_i32gather_pd(_mm512_setzero_pd(), kHalfLanes, hi, table, 8)};
#else
  D r;
  for (int i = 0; i < kHalf; ++i) {
    r.lo[i] = table[index.v[i]];
    r.hi[i] = table[index.v[i + kHalf]];
  }
  return r;
#endif
}
// The words that begin at each of these bytes.
LANCER_LANE U gather_bytes(const void *table, U offset) {
#if defined(__AVX512F__)
  return U((WordVector)_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), kAllLanes, (__m512i)offset.v, table, 1));
#else
  U r;
  for (int i = 0; i < kLanes; ++i) {
    uint32_t word;
    __builtin_memcpy(&word, static_cast<const unsigned char *>(table) + offset.v[i], 4);
    r.v[i] = word;
  }
  return r;
#endif
}

} // namespace
} // namespace lancer
