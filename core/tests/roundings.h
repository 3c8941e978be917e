// Tolerances with their derivation: a number of roundings of numbers up to a given size.
#pragma once

namespace lancer_test {

constexpr double float_roundings(int count, double size = 1.0) { return count * 0x1p-24 * size; }
constexpr double double_roundings(int count, double size = 1.0) { return count * 0x1p-53 * size; }

// A white floor with a normal irradiance of pi: pi, 1 / pi and their product.
constexpr double kWhiteFloor = float_roundings(3);

} // namespace lancer_test
