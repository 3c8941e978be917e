#include "sampling/elementary.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace lancer {
namespace {

// For the cosine: half the square's rounding, and the roundings of both sums, 2.5 x 2^-25 in total, relative to at least
// cos(pi/4); the sine has less. The rest includes the fit's 4e-9.
constexpr double kBound = 1.85 * 0x1p-24;

TEST(Octant, SineAndCosine) {
  for (int i = -100000; i <= 100000; ++i) {
    const float x = 0.25f * float(std::numbers::pi) * float(i) / 100000.0f;
    EXPECT_LE(std::abs(double(sin_octant(x)) - std::sin(double(x))), kBound * std::abs(std::sin(double(x)))) << x;
    EXPECT_LE(std::abs(double(cos_octant(x)) - std::cos(double(x))), kBound * std::cos(double(x))) << x;
  }
}

TEST(Octant, ATurn) {
  // The angle is rounded once, to 2^-25 of at most pi/4 relative to the quarter.
  constexpr double angle = 0x1p-25;
  for (int i = 0; i <= (1 << 20); ++i) {
    const float u = float(i) * 0x1p-20f;
    const SinCos turn = sin_cos_turn(u);
    EXPECT_NEAR(turn.sin, std::sin(2.0 * std::numbers::pi * double(u)), kBound + angle) << u;
    EXPECT_NEAR(turn.cos, std::cos(2.0 * std::numbers::pi * double(u)), kBound + angle) << u;
  }
  EXPECT_EQ(sin_cos_turn(0.25f).cos, 0.0f);
  EXPECT_EQ(sin_cos_turn(0.5f).sin, 0.0f);
}

} // namespace
} // namespace lancer
