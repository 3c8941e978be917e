// Vectors of two and three numbers of any width, with sums in glm's order.
#pragma once

#include "simd/scalar.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>
#include <type_traits>

namespace lancer {

template <class T> struct Vector2 {
  T x, y;

  // Width 1 converts to glm's vectors.
  LANCER_LANE operator glm::vec<2, T>() const requires(std::is_floating_point_v<T>) { return {x, y}; }
};

template <class T> struct Vector3 {
  T x, y, z;

  Vector3() = default;
  LANCER_LANE constexpr Vector3(const T &a, const T &b, const T &c) : x(a), y(b), z(c) {}
  LANCER_LANE explicit constexpr Vector3(const T &a) : x(a), y(a), z(a) {}
  // From one colour or direction for all lanes.
  template <class S>
  LANCER_LANE constexpr Vector3(const glm::vec<3, S> &v) requires(std::is_constructible_v<T, S>) : x(v.x), y(v.y), z(v.z) {}
  // Width 1 converts to glm's vectors.
  LANCER_LANE operator glm::vec<3, T>() const requires(std::is_floating_point_v<T>) { return {x, y, z}; }

  friend LANCER_LANE Vector3 operator+(const Vector3 &a, const Vector3 &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend LANCER_LANE Vector3 operator-(const Vector3 &a, const Vector3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend LANCER_LANE Vector3 operator*(const Vector3 &a, const Vector3 &b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend LANCER_LANE Vector3 operator/(const Vector3 &a, const Vector3 &b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
  friend LANCER_LANE Vector3 operator*(const Vector3 &a, const T &s) { return {a.x * s, a.y * s, a.z * s}; }
  friend LANCER_LANE Vector3 operator*(const T &s, const Vector3 &a) { return {s * a.x, s * a.y, s * a.z}; }
  friend LANCER_LANE Vector3 operator/(const Vector3 &a, const T &s) { return {a.x / s, a.y / s, a.z / s}; }
  friend LANCER_LANE Vector3 operator-(const Vector3 &a) { return {-a.x, -a.y, -a.z}; }
  LANCER_LANE Vector3 &operator+=(const Vector3 &b) { return *this = *this + b; }
  LANCER_LANE Vector3 &operator*=(const Vector3 &b) { return *this = *this * b; }
  LANCER_LANE Vector3 &operator*=(const T &s) { return *this = *this * s; }

  friend LANCER_LANE T dot(const Vector3 &a, const Vector3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend LANCER_LANE Vector3 cross(const Vector3 &a, const Vector3 &b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
  }
  friend LANCER_LANE Vector3 normalize(const Vector3 &a) { return a * (T(1) / sqrt(dot(a, a))); }
  friend LANCER_LANE Vector3 min(const Vector3 &a, const Vector3 &b) { return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; }
  friend LANCER_LANE Vector3 max(const Vector3 &a, const Vector3 &b) { return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; }
  friend LANCER_LANE Vector3 abs(const Vector3 &a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
  friend LANCER_LANE Vector3 sqrt(const Vector3 &a) { return {sqrt(a.x), sqrt(a.y), sqrt(a.z)}; }
  template <class M> friend LANCER_LANE Vector3 select(const M &m, const Vector3 &a, const Vector3 &b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
  }
  friend LANCER_LANE auto same(const Vector3 &a, const Vector3 &b) { return (a.x == b.x) & (a.y == b.y) & (a.z == b.z); }
  friend LANCER_LANE auto black(const Vector3 &a) { return same(a, Vector3(T(0))); }
};

// Vectors in formulas: glm's for one number, Vector3 for lanes.
template <class F> struct VectorOfNumbers { using Type = Vector3<F>; };
template <> struct VectorOfNumbers<float> { using Type = glm::vec3; };
template <> struct VectorOfNumbers<double> { using Type = glm::dvec3; };
template <class F> using Vec3 = typename VectorOfNumbers<F>::Type;
template <class V> using NumberOf = std::remove_cvref_t<decltype(V::x)>;

LANCER_LANE glm::vec3 select(bool m, const glm::vec3 &a, const glm::vec3 &b) { return m ? a : b; }
LANCER_LANE glm::dvec3 select(bool m, const glm::dvec3 &a, const glm::dvec3 &b) { return m ? a : b; }
LANCER_LANE bool same(const glm::vec3 &a, const glm::vec3 &b) { return a == b; }
LANCER_LANE bool black(const glm::vec3 &a) { return a == glm::vec3(0.0f); }
LANCER_LANE glm::dvec3 widen(const glm::vec3 &a) { return glm::dvec3(a); }
LANCER_LANE glm::vec3 narrow(const glm::dvec3 &a) { return glm::vec3(a); }

// Interpolates from a to b.
template <class T> LANCER_LANE Vector3<T> mix(const Vector3<T> &a, const Vector3<T> &b, const T &t) {
  return a * (T(1) - t) + b * t;
}
// For a number or a vector.
template <class T> LANCER_LANE T clamp01(const T &x) { return min(max(x, T(0)), T(1)); }

template <class T> LANCER_LANE auto widen(const Vector3<T> &a) {
  return Vector3<DoubleOf<T>>(widen(a.x), widen(a.y), widen(a.z));
}
template <class D> LANCER_LANE auto narrow(const Vector3<D> &a) {
  return Vector3<decltype(narrow(a.x))>(narrow(a.x), narrow(a.y), narrow(a.z));
}

// Doubles with as many lanes as F.
template <class F> using Double3Of = Vector3<DoubleOf<F>>;

// Rounding for any width, with the bits of ceil() and trunc(), and the nearest finite float.

template <class F> LANCER_LANE F ceil(const F &a) { return -floor(-a); }
template <class F> LANCER_LANE F trunc(const F &a) { return copysign(floor(abs(a)), a); }

// Returns false for infinities and NaN.
template <class F> LANCER_LANE MaskOf<F> is_finite(const F &x) { return x - x == F(0.0f); }

// Returns the nearest finite float: values beyond the range of float are clamped to its ends.
inline float nearest_float(double value) {
  constexpr double largest = double(std::numeric_limits<float>::max());
  return float(std::clamp(value, -largest, largest));
}
inline glm::vec2 nearest_float(const glm::dvec2 &v) { return {nearest_float(v.x), nearest_float(v.y)}; }
inline glm::vec3 nearest_float(const glm::dvec3 &v) { return {nearest_float(v.x), nearest_float(v.y), nearest_float(v.z)}; }

// Scalars of a colour, for choices, weights and alpha.

template <class V> LANCER_LANE NumberOf<V> mean(const V &v) { return (v.x + v.y + v.z) / 3.0f; }

// Luminance of linear light with the primaries of ITU-R BT.709.
template <class T> T luminance(const glm::vec<3, T> &v) { return T(0.2126f) * v.x + T(0.7152f) * v.y + T(0.0722f) * v.z; }

template <class V> LANCER_LANE NumberOf<V> largest(const V &v) { return max(max(v.x, v.y), v.z); }

} // namespace lancer
