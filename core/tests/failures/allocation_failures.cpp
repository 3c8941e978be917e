// No memory, or no thread, at any moment of a render: the call reports it, and the next render is unaffected.
#include "failing.h"
#include "whole_render.h"

#include <gtest/gtest.h>

namespace {

using namespace lancer_test;

struct Case {
  const char *name;
  RenderKind kind;
  Refuse refuse;
};

int64_t left_behind = 0; // live allocations after the last render

std::vector<float> room() { return std::vector<float>(kWholeFloats, 0.0f); }

// Renders with the request of that number refused; returns false if there was no such request.
bool render_refused(const Case &c, uint64_t number, std::vector<float> &picture, RenderOutcome &outcome) {
  const int64_t before = live_memory();
  const Failing failing(c.refuse, number);
  outcome = render_whole(c.kind, picture);
  left_behind = live_memory() - before;
  return failing.refused();
}

class AllocationFailures : public testing::TestWithParam<Case> {};

TEST_P(AllocationFailures, EachIsAnErrorAndLeavesNothingBehind) {
  const Case &c = GetParam();
  std::vector<float> expected = room(), picture = room();
  const RenderOutcome whole = render_whole(c.kind, expected);
  ASSERT_TRUE(whole.whole()) << whole.call << ": " << whole.message;
  RenderOutcome outcome;
  uint64_t number = 1;
  for (; render_refused(c, number, picture, outcome); ++number) {
    SCOPED_TRACE("request " + std::to_string(number) + ", " + (outcome.whole() ? "" : outcome.call) + ": " + outcome.message);
    if (outcome.whole()) {
      // Something did without, a thread of a build for example, with no effect on the picture.
      ASSERT_EQ(picture, expected);
    } else {
      ASSERT_EQ(outcome.status, LANCER_ERROR_MEMORY);
      ASSERT_STRNE(outcome.message, "");
    }
    ASSERT_EQ(left_behind, 0);
  }
  EXPECT_TRUE(outcome.whole()) << outcome.call << ": " << outcome.message;
  EXPECT_EQ(picture, expected);
  // A render makes far more requests than this: the loop has not ended early.
  EXPECT_GT(number, 200u);
}

// Without a render before it: tables that are made once are made here, or fail here.
TEST(AllocationFailures, TheFirstRenderOfAProcessIsNoExceptionToThat) {
  const Case c{"", {}, Refuse::One};
  prepare_whole();
  std::vector<float> picture = room();
  RenderOutcome outcome;
  for (uint64_t number = 1; render_refused(c, number, picture, outcome); ++number)
    if (!outcome.whole()) {
      ASSERT_EQ(outcome.status, LANCER_ERROR_MEMORY) << number << ": " << outcome.call << ": " << outcome.message;
    }
  EXPECT_TRUE(outcome.whole()) << outcome.call << ": " << outcome.message;
}

INSTANTIATE_TEST_SUITE_P(Kinds, AllocationFailures,
                         testing::Values(Case{"BvhPath", {LANCER_PATH, LANCER_BVH, 2}, Refuse::One},
                                         Case{"BvhPathRefined", {LANCER_PATH, LANCER_BVH, 2, true}, Refuse::One},
                                         Case{"BvhPathFromThenOn", {LANCER_PATH, LANCER_BVH, 2}, Refuse::AllFromIt},
                                         Case{"KdtreeClassic", {LANCER_CLASSIC, LANCER_KDTREE, 2}, Refuse::One},
                                         Case{"BruteForceNormals", {LANCER_NORMALS, LANCER_BRUTE_FORCE, 2}, Refuse::AllFromIt}),
                         [](const auto &given) { return given.param.name; });

} // namespace
