// A partition by key keeps the order on both sides, whatever algorithm a library uses for the median: sums over it, and the
// resulting trees, are the same everywhere.
#include "accel/bvh/bvh_build.h"
#include "compile/steps.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

namespace lancer {
namespace {

// Unordered keys, each with several elements.
uint32_t mixed(uint32_t i) { return i * 37u % 101u / 3u; }

TEST(BuildOrder, OfLightsOnBothSidesOfACut) {
  std::vector<DescribedLight> lights(100);
  for (uint32_t i = 0; i < lights.size(); ++i) {
    lights[i].light.number = i;
    lights[i].light.centre.x = double(mixed(i));
  }
  make_cut(lights, 10, 90, {0, 40, 0.0});
  const auto key = [&](uint32_t i) { return std::pair(lights[i].light.centre.x, lights[i].light.number); };
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const bool cut = i >= 10 && i < 90;
    if (!cut) {
      EXPECT_EQ(lights[i].light.number, i);
    }
    if (cut && i != 10 && i != 40) {
      EXPECT_LT(lights[i - 1].light.number, lights[i].light.number) << i;
    }
    for (uint32_t k = 40; i >= 10 && i < 40 && k < 90; ++k)
      EXPECT_LT(key(i), key(k)) << i << " " << k;
  }
}

TEST(BuildOrder, OfBoxesThatAreHalvedByCount) {
  std::vector<BuildRef> first, second(100);
  for (uint32_t i = 0; i < 100; ++i) {
    const float x = float(mixed(i));
    first.emplace_back(Box{{x, 0.0f, 0.0f, 0.0f}, {x + 1.0f, 1.0f, 1.0f, 0.0f}}, i);
  }
  const BuildContext context{};
  const RangeSplitter splitter(first.data(), second.data(), 4, context);
  BuildRange left, right;
  splitter.split(splitter.all(100), true, left, right);
  ASSERT_EQ(left.count(), 50u);
  ASSERT_EQ(right.count(), 50u);
  for (const BuildRange &side : {left, right})
    for (uint32_t i = side.begin + 1; i < side.end; ++i)
      EXPECT_LT(splitter.refs(side)[i - 1].id(), splitter.refs(side)[i].id()) << i;
  EXPECT_LE(left.centroids.hi[0], right.centroids.lo[0]);
}

} // namespace
} // namespace lancer
