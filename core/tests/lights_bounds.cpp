// The bound of a light reports it behind a surface only if no part of it can send light there.
#include "lights/light_bounds.h"
#include "statistics.h"

#include <gtest/gtest.h>

namespace lancer {
namespace {

using testing::Random;

double between(Random &random, double low, double high) { return low + (high - low) * double(random.uniform()); }

TEST(LightBounds, NothingOfThoseBehindIsSeen) {
  Random random(3);
  int behind = 0, ahead = 0, near = 0;
  for (int i = 0; i < 200000; ++i) {
    // A box of any size and shape, including flat ones, at any distance; a plane that misses, touches or cuts it.
    const double size = std::pow(10.0, between(random, -6.0, 3.0));
    const glm::dvec3 first(between(random, -1.0, 1.0), between(random, -1.0, 1.0), between(random, -1.0, 1.0));
    const glm::dvec3 sides(random.next() % 4 ? between(random, 0.0, 1.0) : 0.0, between(random, 0.0, 1.0),
                           between(random, 0.0, 1.0));
    LightBounds bounds;
    bounds.grow(first);
    bounds.grow(first + size * sides);
    const glm::dvec3 way(between(random, -1.0, 1.0), between(random, -1.0, 1.0), between(random, -1.0, 1.0));
    const glm::vec3 n(glm::normalize(way));
    const double top = glm::dot(bounds.centre(), glm::dvec3(n)) + 0.5 * size * glm::dot(sides, glm::dvec3(glm::abs(n)));
    const double off = std::pow(10.0, between(random, -9.0, 1.0)) * size * (random.next() % 2 ? 1.0 : -1.0);
    const glm::dvec3 beside = glm::cross(glm::dvec3(n), {between(random, -1.0, 1.0), 1.0, between(random, -1.0, 1.0)});
    const glm::dvec3 p = glm::dvec3(n) * (top + off) + beside * between(random, -1.0, 1.0) * size + bounds.centre() -
                         glm::dvec3(n) * glm::dot(bounds.centre(), glm::dvec3(n));
    const bool told = bounds.behind(p, glm::dvec3(n));
    behind += told;
    ahead += off < 0.0;
    near += off > 0.0 && !told;
    for (int k = 0; k < 8; ++k) {
      const glm::dvec3 corner = first + size * sides * glm::dvec3(k & 1, k >> 1 & 1, k >> 2 & 1);
      const glm::vec3 wi(glm::normalize(corner - p));
      ASSERT_FALSE(told && glm::dot(wi, n) > 0.0f) << i;
    }
    ASSERT_FALSE(told && off < 0.0) << i;
  }
  // Only boxes that nearly touch the plane, or are far aside, stay undecided.
  EXPECT_GT(behind, 50000);
  EXPECT_GT(ahead, 50000);
  EXPECT_LT(near, behind);
}

} // namespace
} // namespace lancer
