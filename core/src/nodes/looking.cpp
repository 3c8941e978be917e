#include "nodes/looking.h"

#include "sampling/axis_probe.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// The random numbers of the rays of one node at one place.
class LookingNumbers {
public:
  LookingNumbers(const LookingPlace &at, uint32_t count, uint32_t node)
      : pixel_(hash_combine(at.pixel, node)), first_(at.sample * count), dimension_(at.dimension) {}

  // Returns the numbers of a ray: together, the rays of all samples are one sequence.
  glm::vec2 of(uint32_t ray) const { return Sampler(pixel_, first_ + ray).get2(dimension_); }

private:
  uint32_t pixel_, first_, dimension_;
};

// Returns the axes that Cycles sends rays by, with n as the third: what a material makes of few rays depends on them.
glm::dmat3 ray_axes(const glm::dvec3 &n) {
  const bool diagonal = n.x == n.y && n.x == n.z;
  const glm::dvec3 t = glm::normalize(glm::cross(glm::dvec3(diagonal ? -1.0 : 1.0, 1.0, 1.0), n));
  return {t, glm::cross(n, t), n};
}

} // namespace

float open_share(const NodeRays &rays, const LookingPlace &at, const glm::vec3 &n, double distance, uint32_t count, bool alone,
                 uint32_t node) {
  const LookingNumbers numbers(at, count, node);
  const glm::dmat3 axes = ray_axes(glm::dvec3(n));
  Ray some[NodeRays::kMost];
  uint32_t open = 0;
  for (uint32_t first = 0; first < count; first += NodeRays::kMost) {
    const uint32_t now = std::min(count - first, NodeRays::kMost);
    for (uint32_t i = 0; i < now; ++i) {
      const glm::dvec3 way = axes * glm::dvec3(warp_cosine_hemisphere(numbers.of(first + i)));
      some[i] = ray_from(at.surface, way, distance);
      if (!alone)
        some[i].kinds = RayKind::Shadow;
    }
    open += rays.open({some, now}, alone ? at.surface.instance : kNone);
  }
  return float(open) / float(count);
}

namespace {

// The weight of a point at distance r, up to a constant factor.
double cubic_weight(double radius, double r) {
  const double rest = std::max(radius - r, 0.0);
  return rest * rest * rest;
}

// Returns the distance, in units of the radius, within which a share u of the weight over a disk lies: the root x of
// 10 x^2 - 20 x^3 + 15 x^4 - 4 x^5 = u.
double cubic_distance(double u) {
  // Newton's method, kept within the interval in which the root lies.
  double low = 0.0, high = 1.0, x = 0.25;
  for (int i = 0; i < 32; ++i) {
    const double f = x * x * (10.0 + x * (-20.0 + x * (15.0 - 4.0 * x))) - u, rest = 1.0 - x;
    (f < 0.0 ? low : high) = x;
    const double next = x - f / std::max(20.0 * x * rest * rest * rest, 1e-300);
    const double taken = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(taken - x) < 1e-12)
      break;
    x = taken;
  }
  return x;
}

} // namespace

glm::vec3 bevelled_normal(const NodeRays &rays, const LookingPlace &at, double radius, uint32_t count, uint32_t node) {
  const LookingNumbers numbers(at, count, node);
  const glm::dmat3 axes = ray_axes(glm::dvec3(at.surface.ng));
  glm::dvec3 sum(0.0);
  for (uint32_t i = 0; i < count; ++i) {
    // Choose an axis, and a point of the disk across the axis.
    const glm::vec2 u = numbers.of(i);
    const AxisProbe probe(axes[2], axes[0], axes[1], u.x);
    const double r = radius * cubic_distance(double(u.y)), drawn = cubic_weight(radius, r);
    Ray ray;
    probe.place(at.surface.p, r, radius, ray.o, ray.d, ray.tmax);
    ray.time = at.surface.time;
    // Weigh each point of the object on the way by its profile and by the densities of all axes.
    for (const Hit &hit : rays.all(ray, at.surface.instance)) {
      const Surface met = rays.surface(ray, hit);
      const double real = cubic_weight(radius, glm::length(met.p - at.surface.p));
      if (drawn > 0.0)
        sum += probe.weight(glm::dvec3(met.ng)) * (real / drawn) * glm::dvec3(met.ns);
    }
  }
  const double length = glm::length(sum);
  return length > 0.0 ? at.facing(glm::vec3(sum / length)) : glm::vec3(0.0f);
}

} // namespace lancer
