// The lanes of a kernel: the number of floats in a register of this unit's instruction set.
#pragma once

#include "simd/memory.h"
#include "simd/vectors.h"

namespace lancer {
namespace {

#if defined(LANCER_SCALAR)
constexpr int kLanes = 1;
#elif defined(__AVX512F__)
constexpr int kLanes = 16;
#elif defined(__AVX__)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif
#if !defined(LANCER_SCALAR)
constexpr int kHalf = kLanes / 2;
#endif

#if defined(LANCER_SCALAR)
using F = float;
using D = double;
using U = uint32_t;
using M = bool;
LANCER_LANE M mask_of(uint32_t bits) { return bits != 0; }
// Declared again, because operations of many lanes would hide those of one lane.
using lancer::all;
using lancer::any;
using lancer::as_float;
using lancer::bits;
using lancer::each;
using lancer::gather;
using lancer::gather_bytes;
using lancer::lane;
using lancer::narrow;
using lancer::to_float;
using lancer::truncate;
using lancer::widen;
#else
using F = Float<kLanes>;
using D = Double<kLanes>;
using U = Word<kLanes>;
using M = Mask<kLanes>;
LANCER_LANE M mask_of(uint32_t bits) { return mask_from<kLanes>(bits); }
#endif
using V3 = Vector3<F>;
using D3 = Vector3<D>;

// Returns the bits of a block for the lanes from first on.
LANCER_LANE M some(uint32_t lanes, int first) { return mask_of(lanes >> first & ((1u << kLanes) - 1u)); }

LANCER_LANE F load(const float *p) { return load_lanes<kLanes>(p); }
LANCER_LANE U load(const uint32_t *p) { return load_lanes<kLanes>(p); }
LANCER_LANE D load(const double *p) { return load_lanes<kLanes>(p); }
template <class T> LANCER_LANE bool all_same(const T *const *of) { return all_equal<kLanes>(of); }

// Loads and stores vectors in blocks of 16 lanes.
LANCER_LANE V3 load3(const float (*p)[16], int first) { return {load(p[0] + first), load(p[1] + first), load(p[2] + first)}; }
LANCER_LANE D3 load3(const double (*p)[16], int first) { return {load(p[0] + first), load(p[1] + first), load(p[2] + first)}; }
template <class T> LANCER_LANE void store3(T (*p)[16], int first, const auto &a) {
  store(p[0] + first, a.x);
  store(p[1] + first, a.y);
  store(p[2] + first, a.z);
}
// Stores only the lanes of m.
template <class T> LANCER_LANE void store3(T (*p)[16], int first, M m, const auto &a) {
  store(p[0] + first, m, a.x);
  store(p[1] + first, m, a.y);
  store(p[2] + first, m, a.z);
}

} // namespace
} // namespace lancer
