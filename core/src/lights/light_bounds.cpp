#include "lights/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "sampling/elementary.h"

namespace lancer {

namespace {

constexpr double kPi = glm::pi<double>();
// Cones that stand out by less than this, in radians, are taken as contained: as in Cycles, whose trees this one resembles.
constexpr double kContained = 5e-4;
// Axes whose cosine is below this have no plane in common.
constexpr double kOpposite = -0.9995;

glm::dvec3 any_normal(const glm::dvec3 &v) {
  return glm::normalize(std::abs(v.x) < 0.5 ? glm::cross(v, {1, 0, 0}) : glm::cross(v, {0, 1, 0}));
}

} // namespace

void LightCone::add(const LightCone &other) {
  if (other.empty())
    return;
  if (empty()) {
    *this = other;
    return;
  }
  // Start from the wider one; it may hold the other.
  const LightCone wide = other.theta_o > theta_o ? other : *this, narrow = other.theta_o > theta_o ? *this : other;
  axis = wide.axis;
  theta_o = wide.theta_o;
  theta_e = std::max(wide.theta_e, narrow.theta_e);
  if (theta_o + kContained >= kPi)
    return;
  const double cosine = glm::dot(wide.axis, narrow.axis), apart = acos(std::clamp(cosine, -1.0, 1.0));
  if (theta_o + kContained >= std::min(kPi, apart + narrow.theta_o))
    return;
  // Else turn its axis towards the other until both fit.
  theta_o = 0.5 * (apart + wide.theta_o + narrow.theta_o);
  if (theta_o >= kPi) {
    theta_o = kPi;
    return;
  }
  if (cosine < kOpposite) {
    axis = any_normal(wide.axis);
    return;
  }
  const double turn = theta_o - wide.theta_o;
  axis = glm::normalize(wide.axis * cos(turn) + glm::normalize(narrow.axis - wide.axis * cosine) * sin(turn));
}

double LightCone::measure() const {
  if (empty())
    return 0.0;
  const double theta_w = std::min(kPi, theta_o + theta_e), cos_o = cos(theta_o), sin_o = sin(theta_o);
  return 2.0 * kPi * (1.0 - cos_o) + 0.5 * kPi * (2.0 * (theta_w - theta_o) * sin_o - cos(theta_o - 2.0 * theta_w) + cos_o);
}

bool LightBounds::behind(const glm::dvec3 &p, const glm::dvec3 &n) const {
  const glm::dvec3 to = centre() - p, half = 0.5 * (high - low);
  const glm::dvec3 farthest = glm::abs(to) + half;
  // Of a float direction and a float normal each component is off by 2^-24, and so are products and sums: a cosine by less
  // than 1e-6.
  return glm::dot(to, n) + glm::dot(half, glm::abs(n)) < -1e-6 * (farthest.x + farthest.y + farthest.z);
}

void LightBounds::add(const LightBounds &other) {
  if (!(other.energy > 0.0))
    return;
  low = glm::min(low, other.low);
  high = glm::max(high, other.high);
  cone.add(other.cone);
  energy += other.energy;
}

double LightBounds::cost() const {
  if (!(energy > 0.0))
    return 0.0;
  const glm::dvec3 size = high - low;
  const double area = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
  // What lies on a line counts by its length.
  return energy * (area > 0.0 ? area : glm::length(size)) * cone.measure();
}

} // namespace lancer
