#include "lights/tree_light.h"

#include "lights/float4.h"
#include "sampling/color.h"
#include "sampling/elementary.h"

#include <glm/gtc/constants.hpp>

namespace lancer {

namespace {

constexpr double kPi = glm::pi<double>();
// Float moves a coordinate of a tree about 1024 wide by less than this, and one beyond by that share of itself.
constexpr double kPad = 0x1p-22;
// Float has no number for what lies much further; a lamp there is as far as this.
constexpr double kFarthest = 1e30;

// The mean of the channels' sizes, as in Cycles; 0 where nothing shines.
double level(const glm::dvec3 &emission) {
  return brightest(emission) > 0.0 ? (std::abs(emission.x) + std::abs(emission.y) + std::abs(emission.z)) / 3.0 : 0.0;
}

// Half the widest opening of a spot.
double spot_reach(const Light &light) {
  const double half = acos(std::clamp(light.cos_half_angle, 0.0, 1.0));
  return half < 0.5 * kPi - 1e-6 ? atan(tan(half) * std::max(light.stretch_x, light.stretch_y)) : 0.5 * kPi;
}

// What a round light fills, and how far its parts are.
LightView view_round(const TreeLight &light, const glm::vec3 &to, float d) {
  LightView view;
  view.to = to;
  const float r2 = light.radius * light.radius, d2 = d * d;
  view.near2 = d2;
  if (light.kind == TreeLight::Kind::Disk) {
    view.far2 = std::max(d2 + r2, kNearest2);
    view.sin_u = std::sqrt(r2 / view.far2);
    view.cos_u = std::sqrt(d2 / view.far2);
  } else if (d2 > r2) {
    const float sin2 = r2 / d2;
    view.sin_u = std::sqrt(sin2);
    view.cos_u = std::sqrt(1.0f - sin2);
    view.far2 = d2 / std::max(1.0f - sin2, 0x1p-24f);
  } else {
    // Within the ball: light from everywhere, as strong as at 0.7 of its radius.
    view.cos_u = -1.0f;
    view.near2 = view.far2 = 0.5f * r2;
  }
  return view;
}

Importance round_importance(const LightQuery &query, const TreeLight &light, const glm::vec3 &to, float d) {
  const LightView view = view_round(light, to, d);
  ShineCone cone;
  if (!light.spot)
    return importance(query, view, cone, 1.0f, light.energy);
  cone.axis = light.axis;
  cone.cos_all = cone.cos_full = light.cos_e;
  // The best that its rim lets through.
  const float cos_theta = -glm::dot(light.axis, to);
  const float best = cos_theta >= view.cos_u ? 1.0f : cos_theta * view.cos_u + sine_of(cos_theta) * view.sin_u;
  const float inside = best - light.cos_e + kCosineSlack;
  if (!(inside > 0.0f))
    return {};
  const float t = inside < light.blend ? inside / light.blend : 1.0f;
  return importance(query, view, cone, cos_theta, std::max(light.energy * t * t * (3.0f - 2.0f * t), kLeastImportance));
}

float largest_of(Float4 x) { return std::max(std::max(x[0], x[1]), std::max(x[2], x[3])); }

Importance area_importance(const LightQuery &query, const TreeLight &light, const glm::vec3 &to, float d, const glm::vec3 &v) {
  // Look at the four corners.
  const Float4 along_u{1.0f, -1.0f, 1.0f, -1.0f}, along_v{1.0f, 1.0f, -1.0f, -1.0f};
  const Float4 x = v.x + along_u * light.u.x + along_v * light.v.x, y = v.y + along_u * light.u.y + along_v * light.v.y,
               z = v.z + along_u * light.u.z + along_v * light.v.z;
  const Float4 d2 = x * x + y * y + z * z, per_d = 1.0f / sqrt4(larger4(d2, all4(kNearest2)));
  const Float4 ax = x * per_d - to.x, ay = y * per_d - to.y, az = z * per_d - to.z, apart = ax * ax + ay * ay + az * az;
  const Float4 above = query.n.x * x + query.n.y * y + query.n.z * z;
  // |a - b|^2 = 2 (1 - cos): no cancellation however small the light.
  const float one_minus_cos = 0.5f * largest_of(apart);
  LightView view;
  view.to = to;
  view.near2 = d * d;
  view.far2 = std::max(view.near2, largest_of(d2));
  view.cos_u = 1.0f - one_minus_cos;
  view.sin_u = std::sqrt(std::max(0.0f, one_minus_cos * (2.0f - one_minus_cos)));
  const float facing = glm::dot(light.axis, to), slack = kCosineSlack * std::sqrt(view.far2);
  if (!query.transmits && !(facing < kCosineSlack && largest_of(above) > -slack))
    return {};
  ShineCone cone;
  cone.axis = light.axis;
  cone.cos_all = cone.cos_full = light.cos_e;
  return importance(query, view, cone, -facing, light.energy);
}

} // namespace

Importance importance(const LightQuery &query, const TreeLight &light) {
  if (light.kind == TreeLight::Kind::Sun) {
    LightView view;
    view.to = light.axis;
    view.cos_u = light.cos_e;
    view.sin_u = sine_of(view.cos_u);
    view.far2 = 1.0f / std::max(view.cos_u * view.cos_u, 0x1p-40f);
    ShineCone cone;
    cone.cos_all = cone.cos_full = light.cos_e;
    return importance(query, view, cone, 1.0f, light.energy);
  }
  if (light.kind == TreeLight::Kind::Sky)
    return {light.energy, 0.0f};
  if (light.kind == TreeLight::Kind::Cluster) {
    ClusterShape shape;
    shape.centre = glm::vec3(light.centre);
    shape.half = light.u;
    shape.cone = light.cone;
    shape.energy = light.energy;
    return importance(query, shape);
  }
  // In double: a lamp may stand closer than float can tell.
  const glm::vec3 v(light.centre - query.p);
  const float d = glm::length(v);
  const glm::vec3 to = d > 0.0f ? v / d : glm::vec3(0.0f);
  if (light.kind == TreeLight::Kind::Area)
    return area_importance(query, light, to, d, v);
  return round_importance(query, light, to, d);
}

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
  bounds.energy = level(light.emission);
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
  case LightKind::Area:
    known.kind = TreeLight::Kind::Area;
    known.u = glm::vec3(light.half_x * light.x);
    known.v = glm::vec3(light.half_y * light.y);
    for (int corner = 0; corner < 4; ++corner)
      bounds.grow(light.position + (corner & 1 ? light.half_x : -light.half_x) * light.x +
                  (corner & 2 ? light.half_y : -light.half_y) * light.y);
    if (light.spread_scale != 0.0)
      bounds.cone.theta_e = atan(light.tan_half_spread);
    known.cos_e = float(cos(bounds.cone.theta_e));
    bounds.energy *= light.area;
    break;
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
  // Both sides shine: as in Cycles, any direction of the plane stands for that.
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
