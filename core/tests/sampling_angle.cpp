#include "sampling/elementary.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace lancer {
namespace {

// Roundings of 2^-53 each: up to three of the tangent, two of the polynomial's last steps, up to three of the sums that restore
// the octant; and the library's own, of at most a unit in the last place, counts as two.
constexpr double kBound = 10 * 0x1p-53;

TEST(Angle, OfDirectionsAllAround) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-1.0, 1.0), power(-40.0, 40.0);
  double worst = 0.0;
  for (int i = 0; i < 400000; ++i) {
    const double x = i % 3 == 0 ? share(random) * std::exp2(power(random)) : share(random), y = share(random);
    const double want = std::atan2(y, x), got = angle(y, x);
    worst = std::max(worst, std::abs(got - want) / std::abs(want));
  }
  EXPECT_LE(worst, kBound);
}

TEST(Angle, WhereOctantsMeet) {
  EXPECT_EQ(angle(0.0, 0.0), 0.0);
  EXPECT_EQ(angle(0.0, 1.0), 0.0);
  EXPECT_EQ(angle(1.0, 0.0), (std::numbers::pi / 2.0));
  EXPECT_EQ(angle(-1.0, 0.0), -(std::numbers::pi / 2.0));
  EXPECT_EQ(angle(0.0, -1.0), std::numbers::pi);
  for (int eighth = -15; eighth <= 16; ++eighth)
    for (const double apart : {-1e-9, -1e-16, 0.0, 1e-16, 1e-9}) {
      const double phi = eighth * std::numbers::pi / 16.0 + apart, y = std::sin(phi), x = std::cos(phi),
                   want = std::atan2(y, x);
      EXPECT_LE(std::abs(angle(y, x) - want), kBound * std::abs(want)) << eighth << " " << apart;
    }
}

TEST(Angle, SineAndCosineOfATurn) {
  double worst = 0.0;
  for (int i = 0; i <= 1000000; ++i) {
    const double u = i / 1000000.0;
    const SinCos turn = sin_cos_turn(u);
    // Reduce before multiplying, so that the library's angle is as precise.
    const double quarter = std::round(4.0 * u), x = 2.0 * std::numbers::pi * (u - 0.25 * quarter);
    const double s = std::sin(x), c = std::cos(x);
    const double want_s = quarter == 1.0 ? c : quarter == 2.0 ? -s : quarter == 3.0 ? -c : s;
    const double want_c = quarter == 1.0 ? -s : quarter == 2.0 ? -c : quarter == 3.0 ? s : c;
    worst = std::max({worst, std::abs(turn.sin - want_s), std::abs(turn.cos - want_c)});
  }
  // At most 1, with two roundings of 2^-53: of the last sum, and of the square beside it.
  EXPECT_LE(worst, 0x1p-52);
}

} // namespace
} // namespace lancer
