// Arithmetic of Blender's Math node: undefined results are 0. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/site.h"
#include "sampling/elementary.h"
#include "scene/enums.h"
#include "simd/vectors.h"

#include <cmath>

namespace lancer {
namespace {

// C99's fmin() and fmax(): of a number and a NaN, they return the number. Of zeros with different signs they return the first;
// C99 does not define this case.
template <class F> LANCER_LANE F least(const F &a, const F &b) { return select((b < a) | (a != a), b, a); }
template <class F> LANCER_LANE F largest(const F &a, const F &b) { return select((b > a) | (a != a), b, a); }

template <class F> LANCER_LANE F divide(const F &a, const F &b) { return select(b != F(0.0f), a / b, F(0.0f)); }
template <class F> LANCER_LANE F modulo(const F &a, const F &b) {
  return each(a, b, [](float x, float y) { return y != 0.0f ? __builtin_fmodf(x, y) : 0.0f; });
}
template <class F> LANCER_LANE F fraction(const F &a) { return a - floor(a); }

template <class F> LANCER_LANE F power(const F &a, const F &b) {
  const F zero(0.0f), raised = select(a == zero, zero, pow(a, b));
  return select((a < zero) & (b != trunc(b)), zero, select(b == zero, F(1.0f), raised));
}

template <class F> LANCER_LANE F logarithm(const F &a, const F &base) {
  const F zero(0.0f);
  return select((a > zero) & (base > zero), divide(log(a), log(base)), zero);
}

// The minimum, smoothed over the distance k.
template <class F> LANCER_LANE F smooth_minimum(const F &a, const F &b, const F &k) {
  const F smaller = least(a, b), h = largest(k - abs(a - b), F(0.0f)) / k;
  return select(k == F(0.0f), smaller, smaller - h * h * h * k / F(6.0f));
}

template <class F> LANCER_LANE F wrap(const F &a, const F &high, const F &low) {
  const F range = high - low;
  return select(range != F(0.0f), a - range * floor((a - low) / range), low);
}

template <class F> LANCER_LANE F pingpong(const F &a, const F &b) {
  const F two(2.0f);
  return select(b != F(0.0f), abs(fraction((a - b) / (two * b)) * two * b - b), F(0.0f));
}

template <class F> F math(uint32_t operation, const F &a, const F &b, const F &c) {
  constexpr float pi = 3.14159265358979323846f;
  const F zero(0.0f), one(1.0f);
  switch (operation) {
  case MathOperation::Add:
    return a + b;
  case MathOperation::Subtract:
    return a - b;
  case MathOperation::Multiply:
    return a * b;
  case MathOperation::Divide:
    return divide(a, b);
  case MathOperation::MultiplyAdd:
    return a * b + c;
  case MathOperation::Power:
    return power(a, b);
  case MathOperation::Logarithm:
    return logarithm(a, b);
  case MathOperation::Sqrt:
    return select(a > zero, sqrt(a), zero);
  case MathOperation::InverseSqrt:
    return select(a > zero, one / sqrt(a), zero);
  case MathOperation::Absolute:
    return abs(a);
  case MathOperation::Exponent:
    return exp(a);
  case MathOperation::Minimum:
    return least(a, b);
  case MathOperation::Maximum:
    return largest(a, b);
  case MathOperation::LessThan:
    return select(a < b, one, zero);
  case MathOperation::GreaterThan:
    return select(a > b, one, zero);
  case MathOperation::Sign:
    return select(a == zero, zero, select(a < zero, F(-1.0f), one));
  case MathOperation::Compare:
    // Blender's smallest tolerance: one unit in the last place of 1.
    return select((a == b) | (abs(a - b) <= largest(c, F(0x1p-23f))), one, zero);
  case MathOperation::SmoothMin:
    return smooth_minimum(a, b, c);
  case MathOperation::SmoothMax:
    return -smooth_minimum(F(-a), F(-b), c);
  case MathOperation::Round:
    return floor(a + F(0.5f));
  case MathOperation::Floor:
    return floor(a);
  case MathOperation::Ceil:
    return ceil(a);
  case MathOperation::Trunc:
    return trunc(a);
  case MathOperation::Fract:
    return fraction(a);
  case MathOperation::Modulo:
    return modulo(a, b);
  case MathOperation::FlooredModulo:
    return select(b != zero, a - floor(a / b) * b, zero);
  case MathOperation::Wrap:
    return wrap(a, b, c);
  case MathOperation::Snap:
    return floor(divide(a, b)) * b;
  case MathOperation::Pingpong:
    return pingpong(a, b);
  case MathOperation::Sine:
    return sin(a);
  case MathOperation::Cosine:
    return cos(a);
  case MathOperation::Tangent:
    return tan(a);
  case MathOperation::Arcsine:
    return asin(min(max(a, F(-1.0f)), one));
  case MathOperation::Arccosine:
    return acos(min(max(a, F(-1.0f)), one));
  case MathOperation::Arctangent:
    return atan(a);
  case MathOperation::Arctan2:
    return select((a == zero) & (b == zero), zero, atan2(a, b));
  case MathOperation::Sinh:
    return sinh(a);
  case MathOperation::Cosh:
    return cosh(a);
  case MathOperation::Tanh:
    return tanh(a);
  case MathOperation::Radians:
    return a * F(pi / 180.0f);
  case MathOperation::Degrees:
    return a * F(180.0f / pi);
  default:
    return zero;
  }
}

template <class F> Value<F> math_node(const Inputs<F> &in) {
  const F value = math(in.node.option, in.scalar(0), in.scalar(1), in.scalar(2));
  return scalar(in.node.flags & 1 ? clamp01(value) : value);
}
template <class F> Value<F> clamp_node(const Inputs<F> &in) {
  return scalar(F(min(max(in.scalar(0), in.scalar(1)), in.scalar(2))));
}

} // namespace
} // namespace lancer
