// Tolerances that say where they come from: so many roundings of numbers of at most that size.
#pragma once

namespace lancer_test {

constexpr double float_roundings(int count, double size = 1.0) { return count * 0x1p-24 * size; }
constexpr double double_roundings(int count, double size = 1.0) { return count * 0x1p-53 * size; }

// Of a white floor that an irradiance of pi meets head-on: pi, 1 / pi and their product.
constexpr double kWhiteFloor = float_roundings(3);

} // namespace lancer_test
