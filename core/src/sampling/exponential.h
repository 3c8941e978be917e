// exp() for doubles and for lanes of them: the same bits from every library, compiler and number of lanes.
#pragma once

#include <bit>
#include <cstdint>

namespace lancer {

// 2 to the power of a whole number within +-1022: added to such a number it stands in the lowest digits.
[[gnu::always_inline]] inline double power_of_two(double whole) {
  return std::bit_cast<double>(std::bit_cast<uint64_t>(whole + (0x1.8p52 + 1023.0)) << 52);
}

// exp(r) - 1 where |r| <= log(2) / 2. Fitted to 2e-19.
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

// x = whole log(2) + rest, of |x| < 1000. A sum of the first line's size has no fraction; log(2)'s first part has 33 digits, so
// that its product is exact, and the difference from that.
template <class Double> struct ExpParts { Double whole, rest; };
template <class Double> [[gnu::always_inline]] inline ExpParts<Double> exp_parts(Double x) {
  const Double size(0x1.8p52), n = (x * Double(0x1.71547652b82fep+0) + size) - size;
  return {n, (x - n * Double(0x1.62e42fefp-1)) - n * Double(0x1.473de6af278edp-34)};
}

// exp(x) of |x| < 700.
template <class Double> [[gnu::always_inline]] inline Double exp_within(Double x) {
  const ExpParts<Double> at = exp_parts(x);
  return (Double(1.0) + exp_near_zero(at.rest)) * power_of_two(at.whole);
}

} // namespace lancer
