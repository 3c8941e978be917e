// One record for every lane: its numbers side by side, read once where all lanes have the same one.
#pragma once

#include "simd/vectors.h"

namespace lancer {

template <class F, class Record> struct LaneRecords {
  static constexpr int kWidth = LanesOf<F>::kWidth;
  const Record *of[kWidth] = {}; // only the first is read where all are the same
  bool same = true;

  // get: the number, vector or condition of one record.
  template <class Get> LANCER_LANE F number(const Get &get) const {
    if (same)
      return F(get(*of[0]));
    return from_lanes<F>([&](int i) __attribute__((always_inline)) { return get(*of[i]); });
  }
  template <class Get> LANCER_LANE Vec3<F> vector(const Get &get) const {
    if (same)
      return Vec3<F>(get(*of[0]));
    return {from_lanes<F>([&](int i) __attribute__((always_inline)) { return get(*of[i]).x; }),
            from_lanes<F>([&](int i) __attribute__((always_inline)) { return get(*of[i]).y; }),
            from_lanes<F>([&](int i) __attribute__((always_inline)) { return get(*of[i]).z; })};
  }
  template <class Get> LANCER_LANE MaskOf<F> condition(const Get &get) const {
    return number([&](const Record &r) __attribute__((always_inline)) { return get(r) ? 1.0f : 0.0f; }) != F(0.0f);
  }
};

} // namespace lancer
