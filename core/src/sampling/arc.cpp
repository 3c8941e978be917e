// Angles by their tangent, sine or cosine; and the length of two sides.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sampling/angle.h"
#include "sampling/elementary.h"

namespace lancer {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A power of two that brings two sides, of which this is the larger, to where nothing of them is lost.
double into_range(double larger, double largest) {
  return larger > largest ? 0x1p-600 : larger < 1.0 / largest ? 0x1p600 : 1.0;
}

} // namespace

double atan2(double y, double x) {
  if (x != x || y != y)
    return x + y;
  const double a = std::abs(x), b = std::abs(y);
  if (a == 0.0 && b == 0.0)
    return std::copysign(std::signbit(x) ? 3.141592653589793 : 0.0, y);
  if (a == kInfinity || b == kInfinity)
    return std::copysign(angle(b == kInfinity ? 1.0 : 0.0, a == kInfinity ? std::copysign(1.0, x) : 0.0), y);
  const double scale = into_range(std::max(a, b), 0x1p1000);
  return std::copysign(angle(b * scale, x * scale), y);
}

double atan(double x) { return atan2(x, 1.0); }

// Factors of 1 - x^2 keep its digits.
double asin(double x) {
  return std::abs(x) <= 1.0 ? atan2(x, std::sqrt((1.0 - x) * (1.0 + x))) : std::numeric_limits<double>::quiet_NaN();
}
double acos(double x) {
  return std::abs(x) <= 1.0 ? angle(std::sqrt((1.0 - x) * (1.0 + x)), x) : std::numeric_limits<double>::quiet_NaN();
}

double hypot(double x, double y) {
  const double a = std::abs(x), b = std::abs(y);
  if (a == kInfinity || b == kInfinity)
    return kInfinity;
  const double scale = into_range(std::max(a, b), 0x1p500), p = a * scale, q = b * scale;
  return std::sqrt(p * p + q * q) / scale;
}

} // namespace lancer
