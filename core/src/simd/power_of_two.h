// The power of two in a double, and its inverse, both exact: of any width.
#pragma once

#include "simd/double_register.h"

namespace lancer {

LANCER_LANE double with_words(double x, const auto &f) { return std::bit_cast<double>(f(std::bit_cast<uint64_t>(x))); }
namespace {
template <int W> LANCER_LANE Double<W> with_words(const Double<W> &x, const auto &f) {
  if constexpr (OneRegister<W>) {
    using Words = VectorOf<uint64_t, W>;
    return (VectorOf<double, W>)f((Words)x.v);
  } else {
    using Words = VectorOf<uint64_t, W / 2>;
    using Vector = VectorOf<double, W / 2>;
    return {(Vector)f((Words)x.lo), (Vector)f((Words)x.hi)};
  }
}
} // namespace

// 2^floor(log2(x)); x in [2^-1022, 2^1022].
template <class D> LANCER_LANE D power_of_two_within(const D &x) {
  return with_words(
      x, [](auto words) __attribute__((always_inline)) { return words & (0x7ffull << 52); });
}
// Of what that returns.
template <class D> LANCER_LANE D inverse_of_power(const D &power) {
  return with_words(
      power, [](auto words) __attribute__((always_inline)) { return (2046ull << 52) - words; });
}

} // namespace lancer
