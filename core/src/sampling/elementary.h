// Elementary functions that give the same bits on every machine and at every width, and directions and angles in the plane.
#pragma once

#include "simd/scalar.h"

#include <bit>
#include <cstdint>

namespace lancer {

// exp() for double and lanes of it: the same bits with every library, compiler and number of lanes.

// Returns 2 to the power of a whole number within +-1022: the sum has the exponent in its lowest digits.
[[gnu::always_inline]] inline double power_of_two(double whole) {
  return std::bit_cast<double>(std::bit_cast<uint64_t>(whole + (0x1.8p52 + 1023.0)) << 52);
}

// Returns exp(r) - 1 for |r| <= log(2) / 2. Fitted to 2e-19.
template <class Double> [[gnu::always_inline]] inline Double exp_near_zero(Double r) {
  const Double r2 = r * r, r4 = r2 * r2;
  const Double low =
      (Double(0.5) + r * Double(0.1666666666666667)) + r2 * (Double(0.04166666666666667) + r * Double(0.008333333333326141));
  const Double middle = (Double(0.0013888888888883752) + r * Double(0.00019841269874800493)) +
                        r2 * (Double(2.4801587325533363e-05) + r * Double(2.7557255425746435e-06));
  const Double high =
      (Double(2.7557273661348637e-07) + r * Double(2.510520637395701e-08)) + r2 * Double(2.0914679376583935e-09);
  return r + r2 * (low + r4 * (middle + r4 * high));
}

// Splits x = whole log(2) + rest, for |x| < 1000. A sum of the first line's size has no fraction; log(2)'s first part has 33
// digits, so that its product is exact, and so is the difference from it.
template <class Double> struct ExpParts { Double whole, rest; };
template <class Double> [[gnu::always_inline]] inline ExpParts<Double> exp_parts(Double x) {
  const Double size(0x1.8p52), n = (x * Double(0x1.71547652b82fep+0) + size) - size;
  return {n, (x - n * Double(0x1.62e42fefp-1)) - n * Double(0x1.473de6af278edp-34)};
}

// Returns exp(x) for |x| < 700.
template <class Double> [[gnu::always_inline]] inline Double exp_within(Double x) {
  const ExpParts<Double> at = exp_parts(x);
  return (Double(1.0) + exp_near_zero(at.rest)) * power_of_two(at.whole);
}

// Elementary functions with the same bits with every library, compiler and processor: they use only + - * / and sqrt, which
// IEEE 754 rounds, comparisons, and the bits of numbers. Special values are those of C99's annex F.
//
// The error of double functions is within 1 unit in the last place (exp, log, sin, cos), 1.5 (log1p, cosh below 700, erf,
// hypot), 3 (expm1, sinh, cosh, tanh, tan, atan, atan2, asin, acos) or 6 (erfc), for any argument. Float functions round the
// double result once: within 0.500001 units.
double exp(double x);
double expm1(double x);
double sinh(double x);
double cosh(double x);
double tanh(double x);
double log(double x);
double log1p(double x);
double sin(double x);
double cos(double x);
double tan(double x);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);
double hypot(double x, double y);
double erf(double x);
double erfc(double x);

// pow() exists for float only: for double, the product with a double logarithm would lose a dozen bits.
float pow(float x, float y);

[[gnu::always_inline]] inline float exp(float x) { return static_cast<float>(exp(static_cast<double>(x))); }
[[gnu::always_inline]] inline float expm1(float x) { return static_cast<float>(expm1(static_cast<double>(x))); }
[[gnu::always_inline]] inline float sinh(float x) { return static_cast<float>(sinh(static_cast<double>(x))); }
[[gnu::always_inline]] inline float cosh(float x) { return static_cast<float>(cosh(static_cast<double>(x))); }
[[gnu::always_inline]] inline float tanh(float x) { return static_cast<float>(tanh(static_cast<double>(x))); }
[[gnu::always_inline]] inline float log(float x) { return static_cast<float>(log(static_cast<double>(x))); }
[[gnu::always_inline]] inline float log1p(float x) { return static_cast<float>(log1p(static_cast<double>(x))); }
[[gnu::always_inline]] inline float sin(float x) { return static_cast<float>(sin(static_cast<double>(x))); }
[[gnu::always_inline]] inline float cos(float x) { return static_cast<float>(cos(static_cast<double>(x))); }
[[gnu::always_inline]] inline float tan(float x) { return static_cast<float>(tan(static_cast<double>(x))); }
[[gnu::always_inline]] inline float asin(float x) { return static_cast<float>(asin(static_cast<double>(x))); }
[[gnu::always_inline]] inline float acos(float x) { return static_cast<float>(acos(static_cast<double>(x))); }
[[gnu::always_inline]] inline float atan(float x) { return static_cast<float>(atan(static_cast<double>(x))); }
[[gnu::always_inline]] inline float atan2(float y, float x) {
  return static_cast<float>(atan2(static_cast<double>(y), static_cast<double>(x)));
}
[[gnu::always_inline]] inline float hypot(float x, float y) {
  return static_cast<float>(hypot(static_cast<double>(x), static_cast<double>(y)));
}
[[gnu::always_inline]] inline float erfc(float x) { return static_cast<float>(erfc(static_cast<double>(x))); }

// For lanes. exp() clamps beyond the range of float.
template <class F>
concept ManyLanes = LanesOf<F>::kWidth >
1;
template <ManyLanes F> LANCER_LANE F exp(F x) {
  using D = DoubleOf<F>;
  return narrow(exp_within(min(max(widen(x), D(-700.0)), D(700.0))));
}
template <ManyLanes F> LANCER_LANE F expm1(F x) {
  return each(x, [](float a) { return expm1(a); });
}
template <ManyLanes F> LANCER_LANE F log(F x) {
  return each(x, [](float a) { return log(a); });
}
template <ManyLanes F> LANCER_LANE F log1p(F x) {
  return each(x, [](float a) { return log1p(a); });
}
template <ManyLanes F> LANCER_LANE F sin(F x) {
  return each(x, [](float a) { return sin(a); });
}
template <ManyLanes F> LANCER_LANE F cos(F x) {
  return each(x, [](float a) { return cos(a); });
}
template <ManyLanes F> LANCER_LANE F tan(F x) {
  return each(x, [](float a) { return tan(a); });
}
template <ManyLanes F> LANCER_LANE F asin(F x) {
  return each(x, [](float a) { return asin(a); });
}
template <ManyLanes F> LANCER_LANE F acos(F x) {
  return each(x, [](float a) { return acos(a); });
}
template <ManyLanes F> LANCER_LANE F atan(F x) {
  return each(x, [](float a) { return atan(a); });
}
template <ManyLanes F> LANCER_LANE F sinh(F x) {
  return each(x, [](float a) { return sinh(a); });
}
template <ManyLanes F> LANCER_LANE F cosh(F x) {
  return each(x, [](float a) { return cosh(a); });
}
template <ManyLanes F> LANCER_LANE F tanh(F x) {
  return each(x, [](float a) { return tanh(a); });
}
template <ManyLanes F> LANCER_LANE F erfc(F x) {
  return each(x, [](float a) { return erfc(a); });
}
template <ManyLanes F> LANCER_LANE F atan2(F y, F x) {
  return each(y, x, [](float a, float b) { return atan2(a, b); });
}
template <ManyLanes F> LANCER_LANE F pow(F x, F y) {
  return each(x, y, [](float a, float b) { return pow(a, b); });
}
template <ManyLanes F> LANCER_LANE F hypot(F x, F y) {
  return each(x, y, [](float a, float b) { return hypot(a, b); });
}

// The inverse of the error function: maps a uniform number to a Gaussian one.

// Relative error below 4e-7 for |y| < 1. Giles, "Approximating the erfinv function", GPU Computing Gems 2, 2010.
template <class F> LANCER_LANE F erf_inverse(F y) {
  const F w = -log((1.0f - y) * (1.0f + y));
  const auto polynomial = [](F x, const float(&c)[9]) __attribute__((always_inline)) {
    F p = F(c[0]);
    for (int i = 1; i < 9; ++i)
      p = c[i] + p * x;
    return p;
  };
  constexpr float middle[9] = {2.81022636e-08f, 3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f, 0.00021858087f,
                               -0.00125372503f, -0.00417768164f, 0.246640727f,    1.50140941f};
  constexpr float tail[9] = {-0.000200214257f, 0.000100950558f, 0.00134934322f, -0.00367342844f, 0.00573950773f,
                             -0.0076224613f,   0.00943887047f,  1.00167406f,    2.83297682f};
  return select(w < 5.0f, polynomial(w - 2.5f, middle), polynomial(sqrt(w) - 3.0f, tail)) * y;
}

// Sine and cosine in float: the same bits with every library, compiler and number of lanes.

// |x| <= pi/4. Fitted to a relative error of 4e-9: the remaining error is rounding, about one unit in the last place.
template <class F> LANCER_LANE F sin_octant(F x) {
  const F z = x * x;
  return x + x * z * (F(-0.16666655f) + z * (F(0.00833218f) + z * F(-0.00019517f)));
}
template <class F> LANCER_LANE F cos_octant(F x) {
  const F z = x * x;
  return F(1.0f) - F(0.5f) * z + z * z * (F(0.0416666456f) + z * (F(-0.00138873675f) + z * F(2.44384509e-5f)));
}

template <class T> struct SinCos { T sin, cos; };

// Sine and cosine of u turns, u in [0, 1].
template <FloatLanes F> LANCER_LANE SinCos<F> sin_cos_turn(F u) {
  using U = WordOf<F>;
  // Subtract the nearest quarter turn, which is exact, and rotate back by it: swap the two in odd quarters, then set the signs.
  const U quarter = truncate(F(4.0f) * u + F(0.5f));
  const F x = F(6.28318531f) * (u - F(0.25f) * to_float(quarter));
  const F s = sin_octant(x), c = cos_octant(x);
  const MaskOf<F> odd = equal(quarter & U(1u), U(1u));
  return {as_float(as_word(select(odd, c, s)) ^ (quarter & U(2u)) << 30),
          as_float(as_word(select(odd, s, c)) ^ ((quarter + U(1u)) & U(2u)) << 30)};
}

// Angles of directions, and directions from angles, in double: the same bits with every library, compiler and number of lanes.

// Returns the angle from (1, 0) to (x, y), in (-pi, pi]: atan2(y, x), except that zeros have no sign here; 0 for (0, 0). Double
// is double or lanes of it. Fitted to a relative error of 3e-19: the remaining error is rounding, about two units in the last
// place.
template <class Double> LANCER_LANE Double angle(Double y, Double x) {
  const Double zero(0.0), quarter(1.5707963267948966), half(3.141592653589793);
  // Reduce to the first octant, and there to its middle if that is nearer: the tangent is at most that of pi/8.
  const Double a = select(x < zero, -x, x), b = select(y < zero, -y, y);
  const auto steep = b > a;
  const Double low = select(steep, a, b), high = select(steep, b, a);
  const auto far = low > Double(0.41421356237309503) * high;
  const Double t = select(high > zero, select(far, low - high, low) / select(far, low + high, high), zero);
  const Double s = t * t, s2 = s * s, s4 = s2 * s2;
  const Double p0 = Double(-0.333333333333332) + s * Double(0.1999999999995404);
  const Double p1 = Double(-0.14285714280244094) + s * Double(0.11111110785906836);
  const Double p2 = Double(-0.09090897829542213) + s * Double(0.07692061509987053);
  const Double p3 = Double(-0.0666311889427056) + s * Double(0.05847997777822401);
  const Double p4 = Double(-0.05039794067848503) + s * Double(0.038076984083395854);
  const Double p = p0 + s2 * p1 + s4 * (p2 + s2 * p3 + s4 * (p4 + s2 * Double(-0.01792078452560233)));
  const Double part = t + t * s * p;
  // Restore the octant, the quarter, the half.
  const Double of_octant = select(far, Double(0.7853981633974483) + part, part);
  const Double of_quarter = select(steep, quarter - of_octant, of_octant);
  const Double of_half = select(x < zero, half - of_quarter, of_quarter);
  return select(y < zero, -of_half, of_half);
}

// Remainders of the sine and cosine of x, |x| <= pi/4, after x and 1 - x^2 / 2, as functions of x^2: the first times x^3, the
// second times x^4. Fitted to 5e-20 and 4e-18 of both functions.
template <class Double> LANCER_LANE Double sine_rest(Double z) {
  const Double z2 = z * z;
  return (Double(-0.16666666666666632) + z * Double(0.008333333333322418)) +
         z2 * ((Double(-0.00019841269829812405) + z * Double(2.7557313693580386e-06)) +
               z2 * (Double(-2.5050758385411525e-08) + z * Double(1.5896811850312827e-10)));
}
template <class Double> LANCER_LANE Double cosine_rest(Double z) {
  const Double z2 = z * z;
  return (Double(0.0416666666666666) + z * Double(-0.0013888888888874131)) +
         z2 * ((Double(2.4801587289486992e-05) + z * Double(-2.7557314353783e-07)) +
               z2 * (Double(2.087572347823226e-09) + z * Double(-1.1359658803746477e-11)));
}

// Sine and cosine of u turns, u in [0, 1].
template <class Double>
requires(!FloatLanes<Double>) LANCER_LANE SinCos<Double> sin_cos_turn(Double u) {
  // Subtract the nearest quarter turn, which is exact. A sum of this size has no fraction.
  const Double whole(0x1.8p52);
  const Double quarter = (Double(4.0) * u + whole) - whole;
  const Double x = Double(6.283185307179586) * (u - Double(0.25) * quarter);
  const Double z = x * x, z2 = z * z;
  const Double sin_x = x + x * z * sine_rest(z), cos_x = Double(1.0) - Double(0.5) * z + z2 * cosine_rest(z);
  // Rotate back by it.
  const auto first = quarter == Double(1.0), second = quarter == Double(2.0), third = quarter == Double(3.0);
  const auto crossed = first | third;
  const Double across = select(crossed, cos_x, sin_x), along = select(crossed, sin_x, cos_x);
  return {select(second | third, -across, across), select(first | second, -along, along)};
}

// Place of a direction of any length on a map of all directions: x in turns, -1/2 ... 1/2 from +x towards +y, y in half turns
// up from the horizon, -1/2 ... 1/2.
template <class Double> struct MapPlace { Double x, y; };
template <class Double> LANCER_LANE MapPlace<Double> place_on_map(Double x, Double y, Double z, Double across) {
  return {angle(y, x) * Double(0.15915494309189535), angle(z, across) * Double(0.3183098861837907)};
}

} // namespace lancer
