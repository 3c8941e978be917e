// Directions and angles in the plane.
#pragma once

#include "simd/scalar.h"

namespace lancer {

// Sine and cosine in float: the same bits with every library, compiler and number of lanes.

// x| <= pi/4. Fitted to a relative error of 4e-9: the remaining error is rounding, about one unit in the last place.
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
