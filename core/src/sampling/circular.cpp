// Sine, cosine and their inverses with the same bits on every machine.
#include "sampling/elementary.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lancer {

namespace {

// An angle of any size by quarters of a turn:
// x = (quarters + 4 n) pi / 2 + high + low, |high| <= pi / 4 except for rounding, and low the part that does not fit in high:
// together within a relative 2^-60. x is finite.
struct QuarterTurns {
  uint32_t quarters = 0; // 0 ... 3
  double high = 0.0, low = 0.0;
};

// pi / 2: parts of 33 bits, whose products with numbers of 20 bits are exact, and the remainder.
constexpr double kPart1 = 0x1.921fb544p+0, kPart2 = 0x1.0b4611a6p-34, kPart3 = 0x1.3198a2e037073p-69;
// pi / 2 as a double and the remainder.
constexpr double kHalfPi = 0x1.921fb54442d18p+0, kHalfPiRest = 0x1.1a62633145c07p-54;
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;

// The digits of 2 / pi after the binary point.
constexpr uint32_t kDigits[] = {
    0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561, 0xb7246e3a, 0x424dd2e0,
    0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5, 0x2ebb4484, 0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4,
    0x9c845f8b, 0xbdf9283b, 0x1ff897ff, 0xde05980f, 0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d,
    0x7527bac7, 0xebe5f17b, 0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab,
};

// Returns 64 digits of a multi-word number, lowest word first, from this digit on.
uint64_t window(const uint32_t *words, uint32_t digit) {
  const uint32_t *w = words + digit / 32;
  const uint64_t low = w[0] | static_cast<uint64_t>(w[1]) << 32;
  const uint32_t shift = digit % 32;
  return shift == 0 ? low : low >> shift | static_cast<uint64_t>(w[2]) << (64 - shift);
}

// Returns a * b - product, exactly a double. Dekker, "A floating-point technique for extending the available precision", 1971.
double product_rest(double a, double b, double product) {
  const double split = 0x1p27 + 1.0;
  const double a1 = split * a - (split * a - a), a2 = a - a1;
  const double b1 = split * b - (split * b - b), b2 = b - b1;
  return ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2;
}

// Reduces |x| >= 2^-2 by the significant digits of 2 / pi. Payne, Hanek, "Radian reduction for trigonometric functions", 1983.
QuarterTurns by_digits(double x) {
  const uint64_t bits = std::bit_cast<uint64_t>(x);
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff) - 1075;
  const uint64_t whole = (bits & 0xfffffffffffffull) | 1ull << 52;
  // Skip words of 2 / pi whose products with x are whole turns; after seven more words the remainder is below 2^-137.
  const int first = exponent > 2 ? (exponent - 2) / 32 : 0;
  uint32_t product[11] = {};
  for (int half = 0; half < 2; ++half) {
    const uint64_t factor = whole >> 32 * half & 0xffffffffu;
    uint64_t carry = 0;
    for (int i = 0; i < 7; ++i) {
      const uint64_t sum = factor * kDigits[first + 6 - i] + product[i + half] + carry;
      product[i + half] = static_cast<uint32_t>(sum);
      carry = sum >> 32;
    }
    product[7 + half] = static_cast<uint32_t>(carry);
  }
  const uint32_t point = static_cast<uint32_t>(32 * (first + 7) - exponent);
  QuarterTurns result;
  result.quarters = static_cast<uint32_t>(window(product, point)) & 3u;
  uint64_t high = window(product, point - 64), low = window(product, point - 128);
  // Round to the nearest quarter.
  const bool below = high >> 63 != 0;
  if (below) {
    ++result.quarters;
    low = ~low + 1;
    high = ~high + (low == 0 ? 1 : 0);
  }
  const int zeros = high == 0 ? 63 : std::countl_zero(high);
  if (zeros > 0) {
    high = high << zeros | low >> (64 - zeros);
    low <<= zeros;
  }
  const double part = std::ldexp(static_cast<double>(high >> 11), -53 - zeros);
  const double rest = std::ldexp(static_cast<double>((high & 0x7ff) << 42 | low >> 22), -106 - zeros);
  result.high = part * kHalfPi;
  result.low = product_rest(part, kHalfPi, result.high) + (part * kHalfPiRest + rest * kHalfPi);
  if (below != (x < 0.0)) {
    result.high = -result.high;
    result.low = -result.low;
  }
  if (x < 0.0)
    result.quarters = 0u - result.quarters;
  result.quarters &= 3u;
  return result;
}

QuarterTurns quarter_turns(double x) {
  if (std::abs(x) <= 0.5 * kHalfPi)
    return {0, x, 0.0};
  if (std::abs(x) < 0x1p20) {
    // A sum of this size has no fraction.
    constexpr double size = 0x1.8p52;
    const double n = (x * kTwoOverPi + size) - size;
    const double first = x - n * kPart1, step = n * kPart2, second = first - step;
    const double below = n * kPart3 - ((first - second) - step);
    const double high = second - below;
    // The third part's product has a rounding error of 2^-100.
    if (std::abs(high) > 0x1p-30)
      return {static_cast<uint32_t>(static_cast<int32_t>(n)) & 3u, high, (second - high) - below};
  }
  return by_digits(x);
}

// high| <= pi / 4. low is so small that its first order suffices.
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
  // Compute both values: an unpredictable branch costs more than a second value.
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

// Inverse tangent, sine and cosine; and the hypotenuse.
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns a power of two that scales two sides, of which this is the larger, into a range without overflow or underflow.
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

// Factoring 1 - x^2 keeps its digits.
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
