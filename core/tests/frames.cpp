// The local frame of a normal is orthonormal for every direction, also next to its poles.
#include "bsdf/lobe.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace lancer {
namespace {

// Errors against the same frame in double, of a normal that is unit in double.
struct Worst {
  double error = 0.0, angle = 0.0;

  void add(const glm::dvec3 &v) {
    const glm::dvec3 n = glm::normalize(v);
    const double sign = std::copysign(1.0, n.z), a = -1.0 / (sign + n.z);
    const glm::dvec3 t(1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x),
        b(n.x * n.y * a, sign + n.y * n.y * a, -n.y);
    EXPECT_LE(std::abs(glm::dot(t, b)) + std::abs(glm::dot(t, n)) + std::abs(glm::dot(b, n)), 0x1p-49);
    const Frame<float> frame{glm::vec3(n)};
    const glm::dvec3 axis[3] = {frame.t, frame.b, frame.n}, exact[3] = {t, b, n};
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k)
        error = std::max(error, std::abs(axis[i][k] - exact[i][k]));
      angle = std::max(angle, std::abs(glm::dot(axis[i], axis[(i + 1) % 3])));
    }
  }
};

// x x / (1 + z) is at most 1, and four operations each round it by a relative 2^-24; the sum with 1 by half of this. n itself
// has an error of 2^-25 in x, which counts twice, and in z.
constexpr double kBound = 6.0 * 0x1p-24;
// Both axes have this error in three components each.
constexpr double kAngle = 2.0 * 1.7320509 * kBound;

TEST(Frames, OrthonormalForFourMillionDirections) {
  std::mt19937_64 engine(5);
  const auto uniform = [&] { return double(engine() >> 11) * 0x1p-52 - 1.0; };
  Worst worst;
  for (int i = 0; i < 1 << 22; ++i) {
    const glm::dvec3 v(uniform(), uniform(), uniform());
    worst.add(v);
  }
  EXPECT_LE(worst.error, kBound);
  EXPECT_LE(worst.angle, kAngle);
}

// Down to the smallest numbers beside both poles, and at the equator, where signs change.
TEST(Frames, OrthonormalNextToThePoles) {
  Worst worst;
  for (int exponent = -149; exponent < 0; ++exponent)
    for (const double x : {-1.0, 0.0, 1.0, 1.5})
      for (const double y : {-1.25, 0.0, 1.0})
        for (const double z : {-1.0, 1.0}) {
          const glm::dvec3 small(std::ldexp(x, exponent), std::ldexp(y, exponent), z);
          worst.add(small);
          if (x != 0.0 || y != 0.0)
            worst.add({x, y, std::ldexp(z, exponent)});
        }
  worst.add({1.0, 0.0, 0.0});
  worst.add({0.0, -1.0, -0.0});
  EXPECT_LE(worst.error, kBound);
  EXPECT_LE(worst.angle, kAngle);
}

} // namespace
} // namespace lancer
