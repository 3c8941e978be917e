// Exponential functions and logarithms with the same bits on every machine.
#include "sampling/elementary.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lancer {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace

double exp(double x) {
  if (std::abs(x) < 700.0)
    return exp_within(x);
  if (!(x < 710.0))
    return x + kInfinity; // or NaN
  if (x < -746.0)
    return 0.0;
  // Multiply by the power of two in two steps, because the whole power leaves the range of double at both ends; only the second
  // step can round.
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
  if (at.whole > 60.0) // 1 is below the rounding error
    return exp(x);
  // The power minus 1 is exact up to 2^53; beyond it the power dominates.
  const double power = power_of_two(at.whole);
  return (power - 1.0) + power * rest;
}

double sinh(double x) {
  const double a = std::abs(x);
  if (a > 700.0) { // exp() overflows before its half does
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
  // 1 - tanh(20) is below the rounding error.
  const double e = expm1(2.0 * (std::abs(x) < 20.0 ? std::abs(x) : 20.0));
  return x != x ? x : std::copysign(e / (e + 2.0), x);
}

// Natural logarithms, and powers by them.
namespace {

constexpr double kLog2High = 0x1.62e42fefp-1, kLog2Low = 0x1.473de6af278edp-34;

// Returns log(1 + f) + whole log(2), for sqrt(1/2) <= 1 + f < sqrt(2). With s = f / (2 + f) it is 2 atanh(s), and 2 s = f - s
// f: the rounded terms are small compared with f. Fitted to 5e-18.
double near_one(double f, double whole) {
  const double s = f / (2.0 + f), z = s * s, z2 = z * z;
  const double p = ((0.666666666666667 + z * 0.39999999999899505) + z2 * (0.28571428625975487 + z * 0.2222221113479508)) +
                   z2 * z2 * ((0.18182889125261723 + z * 0.15331721600556042) + z2 * 0.14616449685043406);
  return whole * kLog2High + (f - (s * (f - z * p) - whole * kLog2Low));
}

bool is_whole(double y) { return std::floor(y) == y; }
bool is_odd(double y) { return is_whole(y) && !is_whole(0.5 * y); }

} // namespace

double log(double x) {
  int64_t bits = std::bit_cast<int64_t>(x);
  int64_t whole = 0;
  if (!(x >= std::numeric_limits<double>::min())) {
    if (x == 0.0)
      return -std::numeric_limits<double>::infinity();
    if (!(x > 0.0))
      return std::numeric_limits<double>::quiet_NaN();
    bits = std::bit_cast<int64_t>(x * 0x1p54);
    whole = -54;
  } else if (x == std::numeric_limits<double>::infinity()) {
    return x;
  }
  // The exponent relative to sqrt(1/2).
  constexpr int64_t root = std::bit_cast<int64_t>(0x1.6a09e667f3bcdp-1);
  const int64_t exponent = (bits - root) >> 52;
  return near_one(std::bit_cast<double>(bits - (exponent << 52)) - 1.0, static_cast<double>(whole + exponent));
}

double log1p(double x) {
  if (x > -0.29 && x < 0.41)
    return x == 0.0 ? x : near_one(x, 0.0);
  const double u = 1.0 + x;
  if (!(x > -1.0 && x < 0x1p60))
    return log(u);
  // Add the logarithm's slope times the rounding error of 1 + x.
  const double lost = x < 1.0 ? x - (u - 1.0) : 1.0 - (u - x);
  return log(u) + lost / u;
}

float pow(float x, float y) {
  if (x == 1.0f || y == 0.0f)
    return 1.0f;
  const double a = std::abs(static_cast<double>(x)), b = static_cast<double>(y);
  // Results within the range of float have exponents of at most 104, so the product's rounding error is within a relative
  // 2^-46.
  const float power = a == 1.0 ? 1.0f : static_cast<float>(exp(b * log(a)));
  if (!std::signbit(x))
    return power;
  if (x < 0.0f && a < std::numeric_limits<double>::infinity() && !is_whole(b))
    return std::numeric_limits<float>::quiet_NaN();
  return is_odd(b) ? -power : power;
}

// The error function and its complement.

namespace {

// Returns erf(x) for |x| <= 1. Fitted to 7e-18.
double near_zero(double x) {
  const double z = x * x, z2 = z * z, z4 = z2 * z2;
  const double p =
      ((0.12837916709551256 + z * -0.37612638903183543) + z2 * (0.11283791670945006 + z * -0.02686617064323777)) +
      z4 *
          (((0.0052239776071164225 + z * -0.0008548325975389692) + z2 * (0.00012055294904839707 + z * -1.492473690741966e-05)) +
           z4 * ((1.6447424703317362e-06 + z * -1.6208483801871705e-07) +
                 z2 * (1.3720064546777686e-08 + z * -7.795898827002142e-10)));
  return x + x * p;
}

// (1 + 2 x) exp(x^2) erfc(x) for 1/2 <= x <= 28, as a polynomial in (x - 4) / (x + 4), constant term first. The variable is
// that of Schonfelder, "Chebyshev expansions for the error and related functions", 1978. Fitted to 1e-18.
constexpr double kScaled[] = {
    1.2329951186255526,      -0.1396211168405625,     0.015379652102619901,    0.06809705425468844,
    -0.1010390660363143,     0.09373283499853434,     -0.06633036581196795,    0.03716751553379472,
    -0.016197734061059108,   0.00503197001856426,     -0.0007577732634973155,  -0.00019925696553927866,
    0.00015062155590137163,  -2.4398057333996413e-05, -1.1221668942295945e-05, 5.706494720146254e-06,
    2.9313186423696087e-07,  -8.195085083459565e-07,  7.540467350144586e-08,   1.03256669073015e-07,
    -1.8406671051403966e-08, -9.652213521087604e-09,  1.9717656765049794e-09,  0.0,
};

// Returns erfc(x) for x >= 1/2.
double far_out(double x) {
  if (x > 28.0)
    return 0.0;
  const double t = (x - 4.0) / (x + 4.0);
  // Evaluate four terms at a time: in Horner's scheme, each term would wait for the term before.
  const double t2 = t * t, t4 = t2 * t2, t8 = t4 * t4;
  const auto four = [&](const double *c) { return (c[0] + t * c[1]) + t2 * (c[2] + t * c[3]); };
  const double p = (four(kScaled) + t4 * four(kScaled + 4)) +
                   t8 * ((four(kScaled + 8) + t4 * four(kScaled + 12)) + t8 * (four(kScaled + 16) + t4 * four(kScaled + 20)));
  // exp(-x^2): the square of the number's upper half is exact, and the rest is below 2^-15.
  const double upper = std::bit_cast<double>(std::bit_cast<uint64_t>(x) & 0xfffffffff8000000ull);
  const double beside = (x - upper) * (x + upper);
  return exp(-upper * upper) * (1.0 - beside * (1.0 - 0.5 * beside * (1.0 - beside * (1.0 / 3.0)))) * (p / (1.0 + 2.0 * x));
}

} // namespace

double erf(double x) {
  if (!(std::abs(x) > 1.0))
    return near_zero(x);
  return std::copysign(1.0 - far_out(std::abs(x)), x);
}

double erfc(double x) {
  if (!(std::abs(x) > 0.5))
    return 1.0 - near_zero(x);
  return x > 0.0 ? far_out(x) : 2.0 - far_out(-x);
}

} // namespace lancer
