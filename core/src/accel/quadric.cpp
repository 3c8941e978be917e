#include "accel/quadric.h"

#include "accel/edge_sides.h"
#include "sampling/elementary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lancer {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A sum of squares as if computed in twice the precision: next to a surface nearly all of its digits cancel.
struct PreciseSum {
  double value = 0.0, rest = 0.0;

  // Knuth's sum: value + x = s + error, exactly.
  void add(double x) {
    const double s = value + x, shadow = s - value;
    rest += (value - (s - shadow)) + (x - shadow);
    value = s;
  }
  // Veltkamp's splitting: x * x = square + error, exactly. sign is 1 or -1.
  void add_square(double x, double sign) {
    const double scaled = 134217729.0 * x;
    const double high = scaled - (scaled - x), low = x - high;
    const double square = x * x;
    add(sign * square);
    rest += sign * (((high * high - square) + 2.0 * high * low) + low * low);
  }
  double total() const { return value + rest; }
};

// Where a line enters and leaves a convex solid, and whether that place is on the surface that it started from.
// All closed shapes are intersections of convex solids, so a line that enters always leaves: no gap at the rims.
struct Interval {
  double entry = -kInfinity, exit = kInfinity;
  bool entry_is_start = false, exit_is_start = false;
};

constexpr Interval kEmpty{kInfinity, -kInfinity, false, false};

Interval intersection(const Interval &a, const Interval &b) {
  Interval i;
  i.entry = std::max(a.entry, b.entry);
  i.exit = std::min(a.exit, b.exit);
  i.entry_is_start = a.entry >= b.entry ? a.entry_is_start : b.entry_is_start;
  i.exit_is_start = a.exit <= b.exit ? a.exit_is_start : b.exit_is_start;
  return i;
}

// Roots of a t^2 - 2 b t + c = 0 with discriminant = b^2 - a c known better than that difference gives it.
// first is the root of smaller magnitude: c / q loses no digit where c is small.
bool solve(double a, double b, double c, double discriminant, double &first, double &second) {
  if (!(discriminant >= 0.0))
    return false;
  const double q = b + std::copysign(std::sqrt(discriminant), b);
  first = c / q;
  second = q / a;
  return q != 0.0;
}

Interval between(double first, double second, bool first_is_start) {
  if (first < second)
    return {first, second, first_is_start, false};
  return {second, first, false, first_is_start};
}

// b^2 - a c is a - |o x d|^2 (Lagrange): the squared distance of the line from the centre, without the cancellation of o.o.
Interval unit_sphere(const glm::dvec3 &o, const glm::dvec3 &d, double slack) {
  PreciseSum c;
  c.add(-1.0);
  for (int i = 0; i < 3; ++i)
    c.add_square(o[i], 1.0);
  const glm::dvec3 m = glm::cross(o, d);
  const double a = glm::dot(d, d);
  double first, second;
  if (!solve(a, -glm::dot(o, d), c.total(), a - glm::dot(m, m), first, second))
    return kEmpty;
  return between(first, second, std::abs(c.total()) <= slack);
}

// x^2 + y^2 <= 1: the sphere's form with the axis projected out.
Interval unit_tube(const glm::dvec3 &o, const glm::dvec3 &d, double slack) {
  PreciseSum c;
  c.add(-1.0);
  c.add_square(o.x, 1.0);
  c.add_square(o.y, 1.0);
  const double a = d.x * d.x + d.y * d.y;
  if (a == 0.0)
    return c.total() <= 0.0 ? Interval{} : kEmpty;
  const double m = o.x * d.y - o.y * d.x;
  double first, second;
  if (!solve(a, -(o.x * d.x + o.y * d.y), c.total(), a - m * m, first, second))
    return kEmpty;
  return between(first, second, std::abs(c.total()) <= slack);
}

// x^2 + y^2 <= (w / 2)^2 with w = 1 - z >= 0. With m = (o - apex) x d, the same identity gives (m.x^2 + m.y^2) / 4 - m.z^2.
Interval unit_nappe(const glm::dvec3 &o, const glm::dvec3 &d, double slack) {
  const double w = 1.0 - o.z;
  PreciseSum c;
  c.add_square(o.x, 1.0);
  c.add_square(o.y, 1.0);
  c.add_square(0.5 * w, -1.0);
  // Along the cone's own lines this is next to nothing: it needs all of its digits.
  const glm::dvec3 m(difference_of_products(o.y, d.z, -w, d.y), difference_of_products(-w, d.x, o.x, d.z),
                     difference_of_products(o.x, d.y, o.y, d.x));
  const double across = 0.5 * hypot(m.x, m.y), around = std::abs(m.z);
  const double discriminant = (across - around) * (across + around);
  const double a = (d.x * d.x + d.y * d.y) - 0.25 * d.z * d.z;
  const double b = -(o.x * d.x + o.y * d.y + 0.25 * w * d.z);
  const bool starts_here = std::abs(c.total()) <= slack;
  double first, second;

  // Flatter than the cone: both roots lie on one nappe; keep them if it is this one.
  if (a > 0.0) {
    if (!solve(a, b, c.total(), discriminant, first, second) || w - (b / a) * d.z < 0.0)
      return kEmpty;
    return between(first, second, starts_here);
  }
  // Steeper: one root on each nappe, and the line stays inside from there on.
  if (!solve(a, b, c.total(), std::max(discriminant, 0.0), first, second))
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
  double origin[3], direction[3];
  to_object_space(shape, ray, origin, direction);
  ObjectRay scaled;
  if (!normalise_direction(direction, scaled))
    return false;
  const glm::dvec3 o(origin[0], origin[1], origin[2]), d(scaled.d[0], scaled.d[1], scaled.d[2]);

  // Flat and without end: a ray that starts on it never comes back.
  if (shape.kind == ShapeKind::Plane) {
    t = (-o.z / d.z) * scaled.unit;
    return !leaves && ray.tmin < t && t < ray.tmax;
  }

  // The implicit functions grow by at most 4 per unit of every coordinate on the surface (2 sqrt(3), 2 sqrt(2), 2 sqrt(2) + 1).
  const double residual = 4.0 * shape.slack;
  const Interval i = shape.kind == ShapeKind::Sphere ? unit_sphere(o, d, residual)
                     : shape.kind == ShapeKind::Cylinder
                         ? intersection(unit_tube(o, d, residual), unit_slab(o, d, shape.slack))
                         : intersection(unit_nappe(o, d, residual), unit_slab(o, d, shape.slack));
  if (!(i.entry <= i.exit))
    return false;

  // Take the first of both places that is on the ray and not its start.
  t = i.entry * scaled.unit;
  if (!(leaves && i.entry_is_start) && ray.tmin < t && t < ray.tmax)
    return true;
  t = i.exit * scaled.unit;
  return !(leaves && i.exit_is_start) && ray.tmin < t && t < ray.tmax;
}

SurfacePoint quadric_point(ShapeKind kind, const glm::dvec3 &o, const glm::dvec3 &d, double t) {
  const QuadricPoint<float> point = quadric_point(kinds_of(kind), Vector3<double>(o + t * d));
  return {point.p, point.n};
}

glm::dvec2 quadric_uv(ShapeKind kind, const glm::dvec3 &p) {
  if (kind == ShapeKind::Plane)
    return {p.x, p.y};
  const double turn = atan2(p.y, p.x) * (0.5 * std::numbers::inv_pi);
  const double angle = turn < 0.0 ? std::min(turn + 1.0, std::nextafter(1.0, 0.0)) : turn;
  if (kind == ShapeKind::Sphere)
    return {angle, 0.5 + atan2(p.z, hypot(p.x, p.y)) * std::numbers::inv_pi};
  return {angle, 0.5 * (p.z + 1.0)};
}

} // namespace lancer
