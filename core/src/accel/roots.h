// Entry and exit of a line through a convex solid bounded by a quadric, for one solid or several in lanes. Forced inlining, as
// in placed_shape.h.
#pragma once

#include "accel/placed_shape.h"

namespace lancer {

// A sum of squares in twice the precision: near a surface nearly all of its digits cancel.
template <class D> struct PreciseSum {
  D value{0.0}, rest{0.0};

  // Knuth's sum: value + x = s + error, exactly.
  LANCER_LANE void add(D x) {
    const D s = value + x, shadow = s - value;
    rest = rest + ((value - (s - shadow)) + (x - shadow));
    value = s;
  }
  // Veltkamp's splitting: x * x = square + error, exactly.
  LANCER_LANE void add_square(D x) {
    const D square = x * x;
    add(square);
    rest = rest + error_of(x, square);
  }
  LANCER_LANE void subtract_square(D x) {
    const D square = x * x;
    add(-square);
    rest = rest - error_of(x, square);
  }
  LANCER_LANE D total() const { return value + rest; }

private:
  static LANCER_LANE D error_of(D x, D square) {
    const D scaled = D(134217729.0) * x;
    const D high = scaled - (scaled - x), low = x - high;
    return ((high * high - square) + D(2.0) * high * low) + low * low;
  }
};

// Entry and exit of a line through a convex solid, and whether each is the surface point that the ray starts from. All closed
// shapes are intersections of convex solids, so a line that enters always leaves, and there is no gap at the rims.
struct Interval {
  double entry = -__builtin_inf(), exit = __builtin_inf();
  bool entry_is_start = false, exit_is_start = false;
};

LANCER_LANE Interval between(double first, double second, bool first_is_start) {
  if (first < second)
    return {first, second, first_is_start, false};
  return {second, first, false, first_is_start};
}

// Roots of a t^2 - 2 b t + c = 0 for a root with root^2 = b^2 - a c that is more precise than this difference. first is the
// root of smaller magnitude: c / q loses no digit if c is small. Returns false without a solution.
LANCER_LANE bool solve(double a, double b, double c, double root, double &first, double &second) {
  const double q = b + __builtin_copysign(root, b);
  first = c / q;
  second = q / a;
  return q != 0.0;
}

// Finds the first of entry and exit that is on the ray and not its origin; returns false if there is none. unit: of ObjectRay.
// leaves: the ray starts on this surface.
LANCER_LANE bool first_place(const Interval &i, double unit, bool leaves, double tmin, double tmax, double &t) {
  if (!(i.entry <= i.exit))
    return false;
  t = i.entry * unit;
  if (!(leaves && i.entry_is_start) && tmin < t && t < tmax)
    return true;
  t = i.exit * unit;
  return !(leaves && i.exit_is_start) && tmin < t && t < tmax;
}

// The terms of solve() for a line and the unit sphere. The discriminant is computed first, because most lines miss. It is b^2 -
// a c = a - |o x d|^2 (Lagrange), which has no cancellation in o.o; |o x d|^2 / a is the squared distance of the line from the
// centre.
template <class D> struct SphereTerms {
  D a, b, c, discriminant;

  LANCER_LANE void find_discriminant(const D (&o)[3], const D (&d)[3]) {
    const D x = o[1] * d[2] - d[1] * o[2], y = o[2] * d[0] - d[2] * o[0], z = o[0] * d[1] - d[0] * o[1];
    a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    discriminant = a - (x * x + y * y + z * z);
  }
  LANCER_LANE void find_rest(const D (&o)[3], const D (&d)[3]) {
    PreciseSum<D> sum;
    sum.add(D(-1.0));
    for (const D &component : o)
      sum.add_square(component);
    b = -(o[0] * d[0] + o[1] * d[1] + o[2] * d[2]);
    c = sum.total();
  }
};

// slack: bound on |c| for a point on the surface. Returns false without a solution.
LANCER_LANE bool sphere_interval(double a, double b, double c, double root, double slack, Interval &i) {
  double first, second;
  if (!solve(a, b, c, root, first, second))
    return false;
  i = between(first, second, abs(c) <= slack);
  return true;
}

} // namespace lancer
