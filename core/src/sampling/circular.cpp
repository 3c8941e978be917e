// Sine, cosine and tangent of angles of any size.
#include <bit>
#include <cmath>
#include <cstdint>

#include "sampling/angle.h"
#include "sampling/elementary.h"
#include "sampling/quarter_turns.h"

namespace lancer {

namespace {

// |high| <= pi / 4. The low part turns the rest by so little that the first order tells.
double sine_near(double high, double low) {
  const double z = high * high;
  return high + (high * z * sine_rest(z) + low * (1.0 - 0.5 * z));
}
double cosine_near(double high, double low) {
  const double z = high * high, half = 0.5 * z, w = 1.0 - half;
  return w + (((1.0 - w) - half) + (z * z * cosine_rest(z) - high * low));
}

double signed_by(double a, uint32_t negative) {
  return std::bit_cast<double>(std::bit_cast<uint64_t>(a) ^ static_cast<uint64_t>(negative) << 63);
}

} // namespace

double sin(double x) {
  if (!std::isfinite(x))
    return x - x;
  if (std::abs(x) < 0x1p-27)
    return x;
  const QuarterTurns at = quarter_turns(x);
  // Both, for a branch that nothing foretells costs more than the other.
  const double both[2] = {sine_near(at.high, at.low), cosine_near(at.high, at.low)};
  return signed_by(both[at.quarters & 1], at.quarters >> 1);
}

double cos(double x) {
  if (!std::isfinite(x))
    return x - x;
  const QuarterTurns at = quarter_turns(x);
  const double both[2] = {cosine_near(at.high, at.low), sine_near(at.high, at.low)};
  return signed_by(both[at.quarters & 1], (at.quarters + 1) >> 1 & 1);
}

double tan(double x) {
  if (!std::isfinite(x))
    return x - x;
  if (std::abs(x) < 0x1p-27)
    return x;
  const QuarterTurns at = quarter_turns(x);
  const double s = sine_near(at.high, at.low), c = cosine_near(at.high, at.low);
  return at.quarters & 1 ? -c / s : s / c;
}

} // namespace lancer
