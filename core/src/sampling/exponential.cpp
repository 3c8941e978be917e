#include "sampling/exponential.h"

#include <cmath>
#include <limits>

#include "sampling/elementary.h"

namespace lancer {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace

double exp(double x) {
  if (std::abs(x) < 700.0)
    return exp_within(x);
  if (!(x < 710.0))
    return x + kInfinity; // or not a number
  if (x < -746.0)
    return 0.0;
  // In two steps, for neither end of the range holds the whole power; only the second can round.
  const ExpParts<double> at = exp_parts(x);
  const double half = std::floor(0.5 * at.whole);
  return (1.0 + exp_near_zero(at.rest)) * power_of_two(half) * power_of_two(at.whole - half);
}

double expm1(double x) {
  if (!(x < 710.0))
    return x + kInfinity;
  if (x < -40.0)
    return -1.0;
  const ExpParts<double> at = exp_parts(x);
  const double rest = exp_near_zero(at.rest);
  if (at.whole == 0.0)
    return x == 0.0 ? x : rest;
  if (at.whole > 60.0) // 1 is less than what rounding takes
    return exp(x);
  // The power less 1 is exact up to 2^53, and beyond it the larger of the two by far.
  const double power = power_of_two(at.whole);
  return (power - 1.0) + power * rest;
}

double sinh(double x) {
  const double a = std::abs(x);
  if (a > 700.0) { // where exp() is beyond the range before its half is
    const double e = exp(0.5 * a);
    return std::copysign(0.5 * e * e, x);
  }
  const double e = expm1(a);
  return std::copysign(0.5 * (e + e / (e + 1.0)), x);
}

double cosh(double x) {
  const double a = std::abs(x), e = exp(a > 700.0 ? 0.5 * a : a);
  return a > 700.0 ? 0.5 * e * e : 0.5 * (e + 1.0 / e);
}

double tanh(double x) {
  // 1 - tanh(20) is less than what rounding takes.
  const double e = expm1(2.0 * (std::abs(x) < 20.0 ? std::abs(x) : 20.0));
  return x != x ? x : std::copysign(e / (e + 2.0), x);
}

} // namespace lancer
