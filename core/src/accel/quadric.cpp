#include "accel/hit_tests.h"

#include "accel/roots.h"
#include "sampling/elementary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lancer {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Interval kEmpty{kInfinity, -kInfinity, false, false};

Interval intersection(const Interval &a, const Interval &b) {
  Interval i;
  i.entry = std::max(a.entry, b.entry);
  i.exit = std::min(a.exit, b.exit);
  i.entry_is_start = a.entry >= b.entry ? a.entry_is_start : b.entry_is_start;
  i.exit_is_start = a.exit <= b.exit ? a.exit_is_start : b.exit_is_start;
  return i;
}

// Solves with a discriminant; returns false if it is negative.
bool solve_squared(double a, double b, double c, double discriminant, double &first, double &second) {
  return discriminant >= 0.0 && solve(a, b, c, std::sqrt(discriminant), first, second);
}

Interval unit_sphere(const double (&o)[3], const double (&d)[3], double slack) {
  SphereTerms<double> terms;
  terms.find_discriminant(o, d);
  terms.find_rest(o, d);
  Interval i;
  return terms.discriminant >= 0.0 && sphere_interval(terms.a, terms.b, terms.c, std::sqrt(terms.discriminant), slack, i)
             ? i
             : kEmpty;
}

// x^2 + y^2 <= 1: the sphere's form with the axis projected out.
Interval unit_tube(const glm::dvec3 &o, const glm::dvec3 &d, double slack) {
  PreciseSum<double> c;
  c.add(-1.0);
  c.add_square(o.x);
  c.add_square(o.y);
  const double a = d.x * d.x + d.y * d.y;
  if (a == 0.0)
    return c.total() <= 0.0 ? Interval{} : kEmpty;
  const double m = o.x * d.y - o.y * d.x;
  double first, second;
  if (!solve_squared(a, -(o.x * d.x + o.y * d.y), c.total(), a - m * m, first, second))
    return kEmpty;
  return between(first, second, std::abs(c.total()) <= slack);
}

// x^2 + y^2 <= (w / 2)^2 with w = 1 - z >= 0. With m = (o - apex) x d, the same identity gives (m.x^2 + m.y^2) / 4 - m.z^2.
Interval unit_nappe(const glm::dvec3 &o, const glm::dvec3 &d, double slack) {
  const double w = 1.0 - o.z;
  PreciseSum<double> c;
  c.add_square(o.x);
  c.add_square(o.y);
  c.subtract_square(0.5 * w);
  // Along the cone's generators m is nearly zero, so it must not lose digits by cancellation.
  const glm::dvec3 m(difference_of_products(o.y, d.z, -w, d.y), difference_of_products(-w, d.x, o.x, d.z),
                     difference_of_products(o.x, d.y, o.y, d.x));
  const double across = 0.5 * hypot(m.x, m.y), around = std::abs(m.z);
  const double discriminant = (across - around) * (across + around);
  const double a = (d.x * d.x + d.y * d.y) - 0.25 * d.z * d.z;
  const double b = -(o.x * d.x + o.y * d.y + 0.25 * w * d.z);
  const bool starts_here = std::abs(c.total()) <= slack;
  double first, second;

  // A line less steep than the cone: both roots lie on one nappe. Keep them if that nappe has w >= 0.
  if (a > 0.0) {
    if (!solve_squared(a, b, c.total(), discriminant, first, second) || w - (b / a) * d.z < 0.0)
      return kEmpty;
    return between(first, second, starts_here);
  }
  // A line steeper than the cone: one root lies on each nappe, and beyond its root the line stays inside.
  if (!solve_squared(a, b, c.total(), std::max(discriminant, 0.0), first, second))
    return kEmpty;
  if (a == 0.0)
    second = first;
  if (d.z > 0.0)
    return {-kInfinity, std::min(first, second), false, first <= second && starts_here};
  return {std::max(first, second), kInfinity, first >= second && starts_here, false};
}

// -1 <= z <= 1.
Interval unit_slab(const glm::dvec3 &o, const glm::dvec3 &d, double slack) {
  if (d.z == 0.0)
    return std::abs(o.z) <= 1.0 ? Interval{} : kEmpty;
  const Interval i{(-1.0 - o.z) / d.z, (1.0 - o.z) / d.z, std::abs(-1.0 - o.z) <= slack, std::abs(1.0 - o.z) <= slack};
  return d.z > 0.0 ? i : Interval{i.exit, i.entry, i.exit_is_start, i.entry_is_start};
}

} // namespace

bool intersect_quadric(const PlacedShape &shape, const Ray &ray, bool leaves, double &t) {
  double origin[3], direction[3], unit, inverse_unit;
  to_object_space(shape, ray, origin, direction);
  if (!scale_direction(direction, unit, inverse_unit))
    return false;
  const glm::dvec3 o(origin[0], origin[1], origin[2]), d(direction[0], direction[1], direction[2]);

  // A ray that starts on an infinite plane does not hit it again.
  if (shape.kind == ShapeKind::Plane) {
    t = (-o.z / d.z) * unit;
    return !leaves && ray.tmin < t && t < ray.tmax;
  }

  // The implicit functions grow by at most 4 per unit of every coordinate on the surface (2 sqrt(3), 2 sqrt(2), 2 sqrt(2) + 1).
  const double residual = 4.0 * shape.slack;
  const Interval i = shape.kind == ShapeKind::Sphere ? unit_sphere(origin, direction, residual)
                     : shape.kind == ShapeKind::Cylinder
                         ? intersection(unit_tube(o, d, residual), unit_slab(o, d, shape.slack))
                         : intersection(unit_nappe(o, d, residual), unit_slab(o, d, shape.slack));
  return first_place(i, unit, leaves, ray.tmin, ray.tmax, t);
}

} // namespace lancer
