// Results of a formula by name, in lanes and single: every lane must have the bits of the single result.
#pragma once

#include "simd/memory.h"
#include "simd/vectors.h"

#include <bit>
#include <gtest/gtest.h>
#include <string>
#include <type_traits>
#include <vector>

namespace lancer::testing {

// Sets the lanes of a number, vector or condition by get(lane).
template <class F, class T, class Get> void put_lanes(T &to, const Get &get) {
  if constexpr (std::is_same_v<T, F>)
    to = from_lanes<F>(get);
  else if constexpr (std::is_same_v<T, Vec3<F>>)
    to = {from_lanes<F>([&](int i) { return get(i).x; }), from_lanes<F>([&](int i) { return get(i).y; }),
          from_lanes<F>([&](int i) { return get(i).z; })};
  else
    to = from_lanes<F>([&](int i) { return get(i) ? 1.0f : 0.0f; }) != F(0.0f);
}

// The results of a computation, in all of its lanes.
template <class F> class Report {
public:
  static constexpr int kWidth = LanesOf<F>::kWidth;
  struct Entry {
    const char *name;
    uint32_t words[kWidth];
  };
  std::vector<Entry> entries;

  void operator()(const char *name, const F &x) {
    // All NaNs are equal: the compiler chooses which of two NaN operands a sum returns.
    add(name, [&](int i) { return lane(x, i) == lane(x, i) ? as_word(lane(x, i)) : 0x7fc00000u; });
  }
  void operator()(const char *name, const Vec3<F> &v) {
    (*this)(name, v.x);
    (*this)(name, v.y);
    (*this)(name, v.z);
  }
  void operator()(const char *name, const WordOf<F> &x) {
    add(name, [&](int i) { return lane(x, i); });
  }
  void operator()(const char *name, const MaskOf<F> &m) {
    add(name, [&](int i) { return bits(m) >> i & 1u; });
  }

private:
  template <class Get> void add(const char *name, const Get &get) {
    Entry &entry = entries.emplace_back();
    entry.name = name;
    for (int i = 0; i < kWidth; ++i)
      entry.words[i] = get(i);
  }
};

// of: reports of each lane alone. Names the first difference.
template <class F>::testing::AssertionResult holds_each(const Report<F> &lanes, const std::vector<Report<float>> &of) {
  for (size_t k = 0; k < lanes.entries.size(); ++k)
    for (int i = 0; i < Report<F>::kWidth; ++i) {
      const auto &entry = lanes.entries[k];
      const auto &alone = of[size_t(i)].entries[k];
      if (entry.words[i] != alone.words[0] || entry.name != alone.name)
        return ::testing::AssertionFailure() << entry.name << ": lane " << i << " of " << Report<F>::kWidth << " has "
                                             << std::bit_cast<float>(entry.words[i]) << " (" << entry.words[i] << "), alone "
                                             << std::bit_cast<float>(alone.words[0]) << " (" << alone.words[0] << ")";
    }
  for (const Report<float> &alone : of)
    if (alone.entries.size() != lanes.entries.size())
      return ::testing::AssertionFailure() << alone.entries.size() << " results alone";
  return ::testing::AssertionSuccess();
}

// Names a number type without passing a value: lanes wider than registers cannot be arguments.
template <class F> struct Lanes {};

// compute(Lanes<F>(), first): returns a report of the lanes from first on, of kMostLanes.
inline constexpr int kMostLanes = 16;
template <class F, class Compute>
void expect_lanes_hold(const Compute &compute, const std::vector<Report<float>> &alone, const std::string &what) {
  for (int first = 0; first < kMostLanes; first += LanesOf<F>::kWidth) {
    const auto begin = alone.begin() + first;
    ASSERT_TRUE(holds_each(compute(Lanes<F>(), first), {begin, begin + LanesOf<F>::kWidth})) << what;
  }
}

} // namespace lancer::testing
