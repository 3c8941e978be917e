// Loads and stores of lanes: arrays aligned to 64 bytes, or gathers; and single lanes, for code that reads separate memory in
// each lane, or is too rare for a vector version. Internal linkage, as in lanes.h.
#pragma once

#include "simd/double_lanes.h"

namespace lancer {

namespace {

using lancer::gather;
using lancer::gather_bytes;

// Loads W consecutive numbers.
template <int W> LANCER_LANE auto load_lanes(const float *p) {
  if constexpr (W == 1)
    return *p;
  else
    return Float<W>(*reinterpret_cast<const VectorOf<float, W> *>(p));
}
template <int W> LANCER_LANE auto load_lanes(const uint32_t *p) {
  if constexpr (W == 1)
    return *p;
  else
    return Word<W>(*reinterpret_cast<const VectorOf<uint32_t, W> *>(p));
}
template <int W> LANCER_LANE auto load_lanes(const double *p) {
  if constexpr (W == 1)
    return *p;
  else
    return Double<W>(*reinterpret_cast<const VectorOf<double, W / 2> *>(p),
                     *reinterpret_cast<const VectorOf<double, W / 2> *>(p + W / 2));
}
template <int W> LANCER_LANE void store(float *p, Float<W> a) { *reinterpret_cast<VectorOf<float, W> *>(p) = a.v; }
template <int W> LANCER_LANE void store(uint32_t *p, Word<W> a) { *reinterpret_cast<VectorOf<uint32_t, W> *>(p) = a.v; }
template <int W> LANCER_LANE void store(double *p, Double<W> a) {
  *reinterpret_cast<VectorOf<double, W / 2> *>(p) = a.lo;
  *reinterpret_cast<VectorOf<double, W / 2> *>(p + W / 2) = a.hi;
}
LANCER_LANE void store(float *p, float a) { *p = a; }
LANCER_LANE void store(uint32_t *p, uint32_t a) { *p = a; }
LANCER_LANE void store(double *p, double a) { *p = a; }
// Stores only the lanes of m.
template <int W> LANCER_LANE void store(float *p, Mask<W> m, Float<W> a) { store(p, select(m, a, load_lanes<W>(p))); }
template <int W> LANCER_LANE void store(double *p, Mask<W> m, Double<W> a) { store(p, select(m, a, load_lanes<W>(p))); }
LANCER_LANE void store(float *p, bool m, float a) { *p = m ? a : *p; }
LANCER_LANE void store(double *p, bool m, double a) { *p = m ? a : *p; }

// Returns whether all W lanes have the same pointer.
template <int W, class T> LANCER_LANE bool all_equal(const T *const *of) {
  bool same = true;
  for (int i = 1; i < W; ++i)
    same = same && of[i] == of[0];
  return same;
}

template <int W> LANCER_LANE Float<W> gather(const float *table, Word<W> index) {
#if defined(__AVX512F__)
  if constexpr (W == 16)
    return Float<W>((VectorOf<float, W>)_mm512_mask_i32gather_ps(_mm512_setzero_ps(), kAllLanes, (__m512i)index.v, table, 4));
#endif
  Float<W> r;
  for (int i = 0; i < W; ++i)
    r.v[i] = table[index.v[i]];
  return r;
}
template <int W> LANCER_LANE Word<W> gather(const uint32_t *table, Word<W> index) {
#if defined(__AVX512F__)
  if constexpr (W == 16)
    return Word<W>(
        (VectorOf<uint32_t, W>)_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), kAllLanes, (__m512i)index.v, table, 4));
#endif
  Word<W> r;
  for (int i = 0; i < W; ++i)
    r.v[i] = table[index.v[i]];
  return r;
}
template <int W> LANCER_LANE Double<W> gather(const double *table, Word<W> index) {
#if defined(__AVX512F__)
  if constexpr (W == 16) {
    using Vector = VectorOf<double, 8>;
    const __m512i whole = (__m512i)index.v;
    const __m256i lo = _mm512_maskz_extracti32x8_epi32(kHalfLanes, whole, 0),
                  hi = _mm512_maskz_extracti32x8_epi32(kHalfLanes, whole, 1);
    return {(Vector)_mm512_mask_i32gather_pd(_mm512_setzero_pd(), kHalfLanes, lo, table, 8),
            (Vector)_mm512_mask_i32gather_pd(_mm512_setzero_pd(), kHalfLanes, hi, table, 8)};
  }
#endif
  Double<W> r;
  for (int i = 0; i < W / 2; ++i) {
    r.lo[i] = table[index.v[i]];
    r.hi[i] = table[index.v[i + W / 2]];
  }
  return r;
}
// Gathers the words at these byte offsets.
template <int W> LANCER_LANE Word<W> gather_bytes(const void *table, Word<W> offset) {
#if defined(__AVX512F__)
  if constexpr (W == 16)
    return Word<W>(
        (VectorOf<uint32_t, W>)_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), kAllLanes, (__m512i)offset.v, table, 1));
#endif
  Word<W> r;
  for (int i = 0; i < W; ++i) {
    uint32_t word;
    __builtin_memcpy(&word, static_cast<const unsigned char *>(table) + offset.v[i], 4);
    r.v[i] = word;
  }
  return r;
}

} // namespace

LANCER_LANE bool lane(bool a, int) { return a; }

namespace {

template <int W> LANCER_LANE double lane(Double<W> a, int i) { return i < W / 2 ? a.lo[i] : a.hi[i - W / 2]; }
template <int W> LANCER_LANE bool lane(Mask<W> m, int i) { return (bits(m) >> i & 1) != 0; }

} // namespace

// Builds lanes of any type from a function of the lane number.
template <class T> struct ByLane {
  template <class Function> static LANCER_LANE T of(const Function &f) { return f(0); }
};
template <class T, class Number, int W> struct ByWayOfMemory {
  template <class Function> static LANCER_LANE T of(const Function &f) {
    alignas(64) Number numbers[W];
    for (int i = 0; i < W; ++i)
      numbers[i] = f(i);
    return load_lanes<W>(numbers);
  }
};
template <int W> struct ByLane<Float<W>> : ByWayOfMemory<Float<W>, float, W> {};
template <int W> struct ByLane<Double<W>> : ByWayOfMemory<Double<W>, double, W> {};
template <int W> struct ByLane<Word<W>> : ByWayOfMemory<Word<W>, uint32_t, W> {};
template <int W> struct ByLane<Mask<W>> {
  template <class Function> static LANCER_LANE Mask<W> of(const Function &f) {
    uint32_t set = 0;
    for (int i = 0; i < W; ++i)
      set |= f(i) ? 1u << i : 0u;
    return mask_from<W>(set);
  }
};
template <class T, class Function> LANCER_LANE T by_lane(const Function &f) { return ByLane<T>::of(f); }

namespace {

// Declared again, because names for lanes would hide those of single numbers from templates in this file.
using lancer::abs;
using lancer::all;
using lancer::any;
using lancer::as_float;
using lancer::each;
using lancer::gather;
using lancer::gather_bytes;
using lancer::lane;
using lancer::narrow;
using lancer::select;
using lancer::store;
using lancer::to_float;
using lancer::widen;

} // namespace

} // namespace lancer
