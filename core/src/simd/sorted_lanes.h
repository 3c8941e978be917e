// Compaction of lanes, for traversal stacks: eight keys, each with a number. Internal linkage, as in lanes.h.
#pragma once

#include "simd/memory.h"

namespace lancer {
namespace {

// Loads W consecutive numbers from any address.
template <int W> LANCER_LANE Float<W> load_anywhere(const float *p) {
  Float<W> r;
  __builtin_memcpy(&r, p, sizeof(r));
  return r;
}

// Returns a b - c, contracted if the processor can contract: the bits differ between processors.
template <int W> LANCER_LANE Float<W> multiply_subtract(Float<W> a, Float<W> b, Float<W> c) {
#if defined(__AVX512F__)
  if constexpr (W == 16)
    return Float<W>((VectorOf<float, W>)_mm512_fmsub_ps((__m512)a.v, (__m512)b.v, (__m512)c.v));
#endif
#if defined(__FMA__)
  if constexpr (W == 8)
    return Float<W>((VectorOf<float, W>)_mm256_fmsub_ps((__m256)a.v, (__m256)b.v, (__m256)c.v));
#endif
  return a * b - c;
}

// Returns the bits of a <= b.
template <int W> LANCER_LANE uint32_t less_equal_bits(Float<W> a, Float<W> b) {
#if defined(__AVX__)
  if constexpr (W == 8)
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps((__m256)a.v, (__m256)b.v, _CMP_LE_OQ)));
#endif
  return bits(a <= b);
}

// Returns a where a <= b, else NaN.
template <int W> LANCER_LANE Float<W> drop_greater(Float<W> a, Float<W> b) {
#if defined(__AVX512F__)
  if constexpr (W == 16)
    return select(a <= b, a, Float<W>(__builtin_nanf("")));
  else
#endif
    return as_float(as_word(a) | Word<W>((VectorOf<uint32_t, W>)(!(a <= b)).v));
}

#if defined(__AVX2__)
LANCER_LANE __m256i load_eight(const uint32_t *p) { return _mm256_loadu_si256(reinterpret_cast<const __m256i *>(p)); }
LANCER_LANE void store_eight(uint32_t *p, __m256i a) { _mm256_storeu_si256(reinterpret_cast<__m256i *>(p), a); }

#if !defined(__AVX512VL__)
// By mask of eight lanes: the numbers of the set lanes, one byte each. With a loop over the lanes instead, 22 public files
// rendered 4 % slower.
struct SetLanes {
  uint64_t of[256] = {};

  constexpr SetLanes() {
    for (uint32_t mask = 0; mask < 256; ++mask)
      for (uint32_t lane = 0, count = 0; lane < 8; ++lane)
        if (mask >> lane & 1)
          of[mask] |= uint64_t{lane} << 8 * count++;
  }
};
constexpr SetLanes kSetLanes;
#endif

// Writes the lanes of the mask contiguously, each with its number. Returns their count.
LANCER_LANE uint32_t store_close(float *keys, uint32_t *numbers, __m256 k, __m256i n, uint32_t mask) {
#if defined(__AVX512VL__)
  const __mmask8 m = static_cast<__mmask8>(mask);
  _mm256_storeu_ps(keys, _mm256_maskz_compress_ps(m, k));
  store_eight(numbers, _mm256_maskz_compress_epi32(m, n));
#else
  const __m256i lanes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(kSetLanes.of[mask])));
  _mm256_storeu_ps(keys, _mm256_permutevar8x32_ps(k, lanes));
  store_eight(numbers, _mm256_permutevar8x32_epi32(n, lanes));
#endif
  return static_cast<uint32_t>(__builtin_popcount(mask));
}
#endif

// Writes the keys that are not above the limit, and their numbers, contiguously; reads only the first count of eight. May
// overwrite up to eight entries behind them. Returns the number of keys written.
LANCER_LANE uint32_t keep_below(float *keys, uint32_t *numbers, const float *key, const uint32_t *number, uint32_t count,
                                float limit) {
#if defined(__AVX2__)
  const Float<8> k = load_anywhere<8>(key);
  const uint32_t mask = less_equal_bits(k, Float<8>(limit)) & (count >= 8 ? 255u : (1u << count) - 1);
  return store_close(keys, numbers, (__m256)k.v, load_eight(number), mask);
#else
  constexpr int kWidth = 4;
  alignas(32) float k[8];
  uint32_t n[8], mask = 0;
  for (int i = 0; i < 8; i += kWidth) {
    const Float<kWidth> part = load_anywhere<kWidth>(key + i);
    store(k + i, part);
    mask |= less_equal_bits(part, Float<kWidth>(limit)) << i;
  }
  mask &= count >= 8 ? 255u : (1u << count) - 1;
  __builtin_memcpy(n, number, sizeof(n));
  uint32_t kept = 0;
  for (uint32_t i = 0; i < 8; ++i) {
    keys[kept] = k[i];
    numbers[kept] = n[i];
    kept += mask >> i & 1;
  }
  return kept;
#endif
}

// Writes the keys that are not above their ends, and their numbers, contiguously in the given order: three bits each, the first
// in the lowest. May overwrite up to eight entries behind them. Returns the number of keys written. key, end: groups of W
// lanes.
template <int W>
LANCER_LANE uint32_t keep_ordered(float *keys, uint32_t *numbers, const Float<W> (&key)[8 / W], const Float<W> (&end)[8 / W],
                                  const uint32_t *number, uint32_t order) {
#if defined(__AVX2__)
  const __m256i lanes =
      _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(order)), _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21));
  const __m256 k = _mm256_permutevar8x32_ps((__m256)key[0].v, lanes), e = _mm256_permutevar8x32_ps((__m256)end[0].v, lanes);
  const __m256i n = _mm256_permutevar8x32_epi32(load_eight(number), lanes);
#if defined(__AVX512VL__)
  const uint32_t mask = _mm256_cmp_ps_mask(k, e, _CMP_LE_OQ);
#else
  const uint32_t mask = static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(k, e, _CMP_LE_OQ)));
#endif
  return store_close(keys, numbers, k, n, mask);
#else
  alignas(32) float k[8];
  uint32_t mask = 0;
  for (int i = 0; i < 8 / W; ++i) {
    store(k + i * W, key[i]);
    mask |= less_equal_bits(key[i], end[i]) << i * W;
  }
  uint32_t count = 0;
  for (uint32_t i = 0; i < 8; ++i, order >>= 3) {
    const uint32_t lane = order & 7;
    keys[count] = k[lane];
    numbers[count] = number[lane];
    count += mask >> lane & 1;
  }
  return count;
#endif
}

} // namespace
} // namespace lancer
