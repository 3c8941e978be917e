// A number together with its changes over a pixel, along x and y: dual numbers, for which the formulas of nodes are evaluated
// like for any other number. Steps do not change: their sides have the slopes of Cycles. Internal linkage, as in lanes.h.
#pragma once

#include "sampling/elementary.h"
#include "simd/vectors.h"

namespace lancer {
namespace {

template <class F> struct Dual {
  F of, dx, dy;

  Dual() = default;
  LANCER_LANE explicit Dual(const F &value) : of(value), dx(0.0f), dy(0.0f) {}
  LANCER_LANE explicit Dual(float value) requires(!std::is_same_v<F, float>) : Dual(F(value)) {}
  LANCER_LANE explicit Dual(int value) : Dual(F(static_cast<float>(value))) {}
  LANCER_LANE Dual(const F &value, const F &x, const F &y) : of(value), dx(x), dy(y) {}
  // Applies a function: its value, and its slope.
  LANCER_LANE Dual by(const F &value, const F &slope) const { return {value, slope * dx, slope * dy}; }

  friend LANCER_LANE Dual operator+(const Dual &a, const Dual &b) { return {a.of + b.of, a.dx + b.dx, a.dy + b.dy}; }
  friend LANCER_LANE Dual operator-(const Dual &a, const Dual &b) { return {a.of - b.of, a.dx - b.dx, a.dy - b.dy}; }
  friend LANCER_LANE Dual operator*(const Dual &a, const Dual &b) {
    return {a.of * b.of, a.of * b.dx + a.dx * b.of, a.of * b.dy + a.dy * b.of};
  }
  friend LANCER_LANE Dual operator/(const Dual &a, const Dual &b) {
    const F ratio = a.of / b.of;
    return {ratio, (a.dx - ratio * b.dx) / b.of, (a.dy - ratio * b.dy) / b.of};
  }
  friend LANCER_LANE Dual operator-(const Dual &a) { return {-a.of, -a.dx, -a.dy}; }
  LANCER_LANE Dual &operator*=(const Dual &b) { return *this = *this * b; }

  friend LANCER_LANE auto operator<(const Dual &a, const Dual &b) { return a.of < b.of; }
  friend LANCER_LANE auto operator>(const Dual &a, const Dual &b) { return a.of > b.of; }
  friend LANCER_LANE auto operator>=(const Dual &a, const Dual &b) { return a.of >= b.of; }
  friend LANCER_LANE auto operator==(const Dual &a, const Dual &b) { return a.of == b.of; }
  friend LANCER_LANE auto operator!=(const Dual &a, const Dual &b) { return a.of != b.of; }
  friend LANCER_LANE Dual select(const MaskOf<F> &m, const Dual &a, const Dual &b) {
    return {select(m, a.of, b.of), select(m, a.dx, b.dx), select(m, a.dy, b.dy)};
  }
  friend LANCER_LANE Dual min(const Dual &a, const Dual &b) { return select(a < b, a, b); }
  friend LANCER_LANE Dual max(const Dual &a, const Dual &b) { return select(a > b, a, b); }
  friend LANCER_LANE Dual abs(const Dual &a) { return select(a.of > F(0.0f), a, -a); }

  friend LANCER_LANE Dual floor(const Dual &a) { return Dual(floor(a.of)); }
  friend LANCER_LANE Dual sqrt(const Dual &a) {
    const F root = sqrt(a.of);
    return a.by(root, F(0.5f) / root);
  }
  friend LANCER_LANE Dual sin(const Dual &a) { return a.by(sin(a.of), cos(a.of)); }
  friend LANCER_LANE Dual cos(const Dual &a) { return a.by(cos(a.of), -sin(a.of)); }
  friend LANCER_LANE Dual tan(const Dual &a) {
    const F value = tan(a.of);
    return a.by(value, F(1.0f) + value * value);
  }
  friend LANCER_LANE Dual hypot(const Dual &a, const Dual &b) {
    const F size = hypot(a.of, b.of);
    return {size, (a.of * a.dx + b.of * b.dx) / size, (a.of * a.dy + b.of * b.dy) / size};
  }
  friend LANCER_LANE Dual atan2(const Dual &y, const Dual &x) {
    const F squared = x.of * x.of + y.of * y.of, along_x = -y.of / squared, along_y = x.of / squared;
    return {atan2(y.of, x.of), along_x * x.dx + along_y * y.dx, along_x * x.dy + along_y * y.dy};
  }
  // The remainder of a division changes with the dividend, as in Cycles.
  friend LANCER_LANE Dual modulo(const Dual &a, const Dual &b) { return {modulo(a.of, b.of), a.dx, a.dy}; }
};

} // namespace

// Dual numbers have the conditions of their values.
template <class F> struct LanesOf<Dual<F>> { using Mask = MaskOf<F>; };

} // namespace lancer
