// Results of a formula by name, in lanes and one by one: every lane must hold the bits of the single number.
#pragma once

#include "simd/memory.h"
#include "simd/vectors.h"

#include <bit>
#include <gtest/gtest.h>
#include <string>
#include <type_traits>
#include <vector>

namespace lancer::testing {

// Some lanes of a number, vector or condition from those of each lane: get(lane).
template <class F, class T, class Get> void put_lanes(T &to, const Get &get) {
  if constexpr (std::is_same_v<T, F>)
    to = from_lanes<F>(get);
  else if constexpr (std::is_same_v<T, Vec3<F>>)
    to = {from_lanes<F>([&](int i) { return get(i).x; }), from_lanes<F>([&](int i) { return get(i).y; }),
          from_lanes<F>([&](int i) { return get(i).z; })};
  else
    to = from_lanes<F>([&](int i) { return get(i) ? 1.0f : 0.0f; }) != F(0.0f);
}

// What a computation found, in all of its lanes.
template <class F> class Report {
public:
  static constexpr int kWidth = LanesOf<F>::kWidth;
  struct Entry {
    const char *name;
    uint32_t words[kWidth];
  };
  std::vector<Entry> entries;

  void operator()(const char *name, const F &x) {
    // Not-a-numbers are all alike: which of two such operands a sum keeps is the compiler's choice.
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

// of: reports of each lane alone. Names the first that differs.
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

// Names a number type without passing one: lanes that are wider than registers are no arguments.
template <class F> struct Lanes {};

// compute(Lanes<F>(), first): a report of the lanes from first on, of kMostLanes that there are.
inline constexpr int kMostLanes = 16;
template <class F, class Compute>
void expect_lanes_hold(const Compute &compute, const std::vector<Report<float>> &alone, const std::string &what) {
  for (int first = 0; first < kMostLanes; first += LanesOf<F>::kWidth) {
    const auto begin = alone.begin() + first;
    ASSERT_TRUE(holds_each(compute(Lanes<F>(), first), {begin, begin + LanesOf<F>::kWidth})) << what;
  }
}

} // namespace lancer::testing
