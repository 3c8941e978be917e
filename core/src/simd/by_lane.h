// Access to single lanes: for code that reads separate memory in each lane, or is too rare for a vector version.
#pragma once

#include "simd/memory.h"

namespace lancer {

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
