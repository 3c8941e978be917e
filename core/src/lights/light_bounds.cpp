#include "lights/light_bounds.h"

#include "sampling/elementary.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lancer {

namespace {

constexpr double kPi = glm::pi<double>();
// A cone that extends beyond another by less than this, in radians, is treated as contained, as in Cycles, whose light trees
// have the same shape.
constexpr double kContained = 5e-4;
// Two axes whose cosine is below this are treated as opposite and define no plane.
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
  // Start from the wider cone, which may contain the other one.
  const LightCone wide = other.theta_o > theta_o ? other : *this, narrow = other.theta_o > theta_o ? *this : other;
  axis = wide.axis;
  theta_o = wide.theta_o;
  theta_e = std::max(wide.theta_e, narrow.theta_e);
  if (theta_o + kContained >= kPi)
    return;
  const double cosine = glm::dot(wide.axis, narrow.axis), apart = acos(std::clamp(cosine, -1.0, 1.0));
  if (theta_o + kContained >= std::min(kPi, apart + narrow.theta_o))
    return;
  // Otherwise turn the wider cone's axis towards the narrower cone until a cone contains both.
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
  // Each component of a float direction and of a float normal has an error of 2^-24, and so have products and sums: the error
  // of a cosine is below 1e-6.
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
  // The bounds of a line are weighted by their length.
  return energy * (area > 0.0 ? area : glm::length(size)) * cone.measure();
}

namespace {

// Rounding to float moves a coordinate of a tree about 1024 wide by less than this, and a coordinate beyond by this share of
// itself.
constexpr double kPad = 0x1p-22;
// Lamps further away than this are placed at this distance, because float cannot represent much larger coordinates.
constexpr double kFarthest = 1e30;

// Returns the mean of the channels' absolute values, as in Cycles: light that is taken away counts as much as light that is
// given.
double level(const glm::dvec3 &emission) { return (std::abs(emission.x) + std::abs(emission.y) + std::abs(emission.z)) / 3.0; }

// Returns half of the widest opening angle of a spot; of a skewed cone the angle of the half-space that contains it.
double spot_reach(const Light &light) {
  if (light.skewed_cone)
    return 0.5 * kPi;
  const double half = acos(std::clamp(light.cos_half_angle, 0.0, 1.0));
  return half < 0.5 * kPi - 1e-6 ? atan(tan(half) * std::max(light.stretch_x, light.stretch_y)) : 0.5 * kPi;
}

} // namespace

ShineCone shine_cone(const LightCone &cone) {
  ShineCone result;
  result.axis = glm::vec3(cone.axis);
  result.cos_o = float(cos(cone.theta_o));
  result.sin_o = float(sin(cone.theta_o));
  const double all = cone.theta_o + cone.theta_e, full = cone.theta_e - cone.theta_o;
  result.cos_all = all >= kPi ? -2.0f : float(cos(all));
  result.cos_full = full < 0.0 ? 2.0f : float(cos(full));
  return result;
}

ClusterShape cluster_shape(const LightBounds &bounds) {
  ClusterShape shape;
  const glm::dvec3 low = glm::clamp(bounds.low, -kFarthest, kFarthest), high = glm::clamp(bounds.high, -kFarthest, kFarthest);
  const glm::dvec3 centre = 0.5 * (low + high);
  const double pad = kPad * (1024.0 + std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z));
  shape.centre = glm::vec3(centre);
  shape.half = glm::vec3(0.5 * (high - low) + pad);
  shape.cone = shine_cone(bounds.cone);
  shape.energy = float(bounds.energy);
  return shape;
}

DescribedLight describe(const Light &light, uint32_t number) {
  DescribedLight result;
  TreeLight &known = result.light;
  LightBounds &bounds = result.bounds;
  result.met = has_extent(light);
  known.number = number;
  known.centre = glm::clamp(light.position, -kFarthest, kFarthest);
  known.axis = glm::vec3(-light.z);
  bounds.cone = {-light.z, 0.0, 0.5 * kPi};
  bounds.energy = level(light.emission) * light.level;
  switch (light.kind) {
  case LightKind::Point:
  case LightKind::Spot:
    known.kind = light.soft_falloff ? TreeLight::Kind::Disk : TreeLight::Kind::Ball;
    known.radius = float(light.radius);
    bounds.grow(light.position - light.radius);
    bounds.grow(light.position + light.radius);
    if (light.kind == LightKind::Point) {
      bounds.cone.theta_o = kPi;
      break;
    }
    known.spot = true;
    bounds.cone.theta_e = spot_reach(light);
    known.cos_e = float(cos(bounds.cone.theta_e));
    known.blend = float(light.blend_width);
    if (!(light.cos_half_angle < 1.0))
      bounds.energy = 0.0;
    break;
  case LightKind::Area: {
    glm::dvec3 side_y = light.half_y * light.y;
    if (light.skew != 0.0)
      side_y += light.skew * light.x;
    known.kind = TreeLight::Kind::Area;
    known.u = glm::vec3(light.half_x * light.x);
    known.v = glm::vec3(side_y);
    for (int corner = 0; corner < 4; ++corner)
      bounds.grow(light.position + (corner & 1 ? light.half_x : -light.half_x) * light.x + (corner & 2 ? side_y : -side_y));
    if (light.spread_scale != 0.0)
      bounds.cone.theta_e = atan(light.tan_half_spread);
    known.cos_e = float(cos(bounds.cone.theta_e));
    bounds.energy *= light.area;
    break;
  }
  case LightKind::Sun:
    known.kind = TreeLight::Kind::Sun;
    known.axis = glm::vec3(light.z);
    bounds.cone.theta_e = acos(1.0 - std::min(light.one_minus_cos_sun, 1.0));
    known.cos_e = float(1.0 - std::min(light.one_minus_cos_sun, 1.0));
    bounds.grow(glm::dvec3(0.0));
    break;
  }
  return result;
}

DescribedLight describe_sky(double mean, uint32_t number) {
  DescribedLight result;
  result.light.kind = TreeLight::Kind::Sky;
  result.light.number = number;
  result.bounds.cone = {{0.0, 0.0, -1.0}, kPi, 0.0};
  result.bounds.energy = kPi * mean;
  result.bounds.grow(glm::dvec3(0.0));
  return result;
}

DescribedLight describe_triangle(const glm::dvec3 (&corners)[3], double energy, uint32_t number) {
  LightBounds bounds;
  for (const glm::dvec3 &corner : corners)
    bounds.grow(corner);
  // Both sides emit. As in Cycles, a cone with theta_o = pi / 2 around an arbitrary direction in the plane represents both.
  const glm::dvec3 side = corners[0] - corners[1];
  bounds.cone = {glm::length(side) > 0.0 ? glm::normalize(side) : glm::dvec3(0.0, 0.0, 1.0), 0.5 * kPi, 0.5 * kPi};
  bounds.energy = energy;
  return describe_cluster(bounds, number);
}

DescribedLight describe_cluster(const LightBounds &bounds, uint32_t number) {
  DescribedLight result;
  const ClusterShape shape = cluster_shape(bounds);
  result.light.kind = TreeLight::Kind::Cluster;
  result.light.number = number;
  result.light.centre = bounds.centre();
  result.light.u = shape.half;
  result.light.cone = shape.cone;
  result.bounds = bounds;
  return result;
}

} // namespace lancer
