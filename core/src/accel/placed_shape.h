// The record of an instance for traversals, and the transformation of rays into its space. The transformation moves a ray's
// origin near the instance's centre, with the same numbers for every accelerator. Plain records and forced inlining: the
// kernels are compiled once per instruction set and must not emit a shared symbol.
#pragma once

#include "scene/ray.h"
#include "simd/double_register.h"
#include "simd/vectors.h"

#include <cstdint>

namespace lancer {

// The power of two in a double, and its inverse, both exact, for any number of lanes.
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
// Returns 1 / power, exactly, for a power of two.
template <class D> LANCER_LANE D inverse_of_power(const D &power) {
  return with_words(
      power, [](auto words) __attribute__((always_inline)) { return (2046ull << 52) - words; });
}

enum class ShapeKind : uint32_t;
struct PlacementKey;

// The box frame of a mesh or of the whole scene: p_box = (p - centre) * scale. scale is a power of two that brings the largest
// half extent into [0.5, 1], so that float boxes have the same relative error at every size and place.
struct PlacementFrame {
  double centre[3] = {0.0, 0.0, 0.0};
  double scale = 1.0;
};

struct alignas(32) PlacedShape {
  double to_object[4][4]; // columns of a 3 x 4 matrix, each followed by a 0
  PlacementFrame frame;   // box frame in object space; unit for exact surfaces
  double slack;           // exact surfaces: bound on the distance by which rounding lifts a stored hit point off the surface,
                          // object space
  ShapeKind kind;
  uint32_t mesh;                 // kNone for exact surfaces
  uint32_t hidden_from;          // bits of Ray::kinds
  uint32_t first_key, key_count; // of GeometryView::keys; 0: the shape stands still
};

// Points are o + tau d; t = t0 + tau * unit is the parameter of the world ray. d is the object-space direction over a power of
// two, its largest component in [1, 2), so that no scale overflows or underflows. o is the ray's closest approach to the
// frame's centre. So the coordinates have the magnitude of the mesh's size, however far the viewer is.
struct ObjectRay {
  double o[3];
  double q[3]; // o relative to the frame's centre
  double d[3];
  double t0;
  double unit, inverse_unit; // powers of two
};
// ObjectRay as vectors: one ray for each lane of D.
template <class V, class D> struct EnteredRay {
  V o, q, d;
  D t0, unit, inverse_unit;
};

template <class D> LANCER_LANE D largest_component(const Vector3<D> &v) { return max(v.z, max(v.y, v.x)); }
template <class D> LANCER_LANE D sum_of_components(const Vector3<D> &v) { return v.x + v.y + v.z; }

// Computes the scale that divides a direction by the power of two of its largest component. Returns false if the direction is
// zero, not finite, or beyond 2^+-1000.
template <class D> LANCER_LANE auto scale_of(const D &largest, const D &sum, D &unit, D &inverse_unit) {
  inverse_unit = power_of_two_within(largest);
  unit = inverse_of_power(inverse_unit);
  return (largest >= D(0x1p-1000)) & (sum <= D(0x1p1000));
}
template <class D> LANCER_LANE auto scale_direction(D (&d)[3], D &unit, D &inverse_unit) {
  const Vector3<D> size(abs(d[0]), abs(d[1]), abs(d[2]));
  const auto usable = scale_of(largest_component(size), sum_of_components(size), unit, inverse_unit);
  for (D &component : d)
    component = component * unit;
  return usable;
}

// Transforms origin and direction of a ray to object space; t is unchanged. m(column, row): element of the 3 x 4 matrix.
template <class D, class Matrix>
LANCER_LANE void to_object_space(const Matrix &m, const D (&from_o)[3], const D (&from_d)[3], D (&o)[3], D (&d)[3]) {
  for (int i = 0; i < 3; ++i) {
    const D x = m(0, i), y = m(1, i), z = m(2, i);
    o[i] = x * from_o[0] + y * from_o[1] + z * from_o[2] + m(3, i);
    d[i] = x * from_d[0] + y * from_d[1] + z * from_d[2];
  }
}
template <class D, class Matrix> LANCER_LANE void to_object_space(const Matrix &m, const Ray &ray, D (&o)[3], D (&d)[3]) {
  const D from_o[3] = {D(ray.o.x), D(ray.o.y), D(ray.o.z)}, from_d[3] = {D(ray.d.x), D(ray.d.y), D(ray.d.z)};
  to_object_space(m, from_o, from_d, o, d);
}
LANCER_LANE void to_object_space(const PlacedShape &shape, const Ray &ray, double (&o)[3], double (&d)[3]) {
  to_object_space(
      [&](int column, int row) __attribute__((always_inline)) { return shape.to_object[column][row]; }, ray, o, d);
}

// Restarts the ray o + t d at its closest approach to the frame's centre. Returns false if the ray is not usable.
template <class V, class D> LANCER_LANE auto enter_frame(const V &centre, const V &o, const V &d, EnteredRay<V, D> &ray) {
  const V size = abs(d);
  const auto scaled = scale_of<D>(largest_component(size), sum_of_components(size), ray.unit, ray.inverse_unit);
  ray.d = d * ray.unit;
  const V f = o - centre;
  const D tau0 = -dot(f, ray.d) / dot(ray.d, ray.d);
  ray.q = f + tau0 * ray.d;
  ray.o = ray.q + centre;
  ray.t0 = tau0 * ray.unit;
  return scaled & (abs(ray.t0) + sum_of_components(abs(ray.q)) < D(__builtin_inf()));
}
LANCER_LANE bool enter_frame(const PlacementFrame &frame, const double (&o)[3], const double (&d)[3], ObjectRay &ray) {
  const auto vector = [](const double(&v)[3]) __attribute__((always_inline)) { return Vector3<double>(v[0], v[1], v[2]); };
  EnteredRay<Vector3<double>, double> entered;
  const bool usable = enter_frame(vector(frame.centre), vector(o), vector(d), entered);
  const auto put = [](const Vector3<double> &v, double(&to)[3]) __attribute__((always_inline)) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  };
  put(entered.o, ray.o);
  put(entered.q, ray.q);
  put(entered.d, ray.d);
  ray.t0 = entered.t0;
  ray.unit = entered.unit;
  ray.inverse_unit = entered.inverse_unit;
  return usable;
}

// Returns a shape as it is placed at the time of a ray: itself where it stands still, otherwise `moved`, which is filled. keys:
// of the geometry.
const PlacedShape &shape_at(const PlacedShape &shape, const PlacementKey *keys, float time, PlacedShape &moved);

// Returns whether the shape is visible to the ray's kind.
LANCER_LANE bool visible(const PlacedShape &shape, const Ray &ray) { return (ray.kinds & ~shape.hidden_from) != 0; }

// Finds the first t with tmin < t < tmax where the ray hits the exact surface; returns false if there is none. leaves: the ray
// starts on this surface, so the root at its origin is skipped.
bool intersect_quadric(const PlacedShape &shape, const Ray &ray, bool leaves, double &t);

// Moves t, at first the ray's tmin, to the next hit on an exact surface; returns false if there is none.
LANCER_LANE bool next_place(const PlacedShape &shape, uint32_t instance, const Ray &ray, double &t) {
  if (t == ray.tmin)
    return intersect_quadric(shape, ray, ray.skip_instance == instance, t);
  Ray rest = ray;
  rest.tmin = t;
  return intersect_quadric(shape, rest, ray.skip_instance == instance, t);
}

// Stores the first hit on an exact surface that counts, if that hit is closer than the best one. next(t): moves t to the next
// hit; returns false if there is none. store(hit): returns false where the hit does not count.
template <class Next, class Store>
LANCER_LANE void try_places(uint32_t instance, double t, const Hit &best, const Next &next, const Store &store) {
  while (next(t) && closer(t, instance, 0, best) && !store(Hit{t, 0.0, 0.0, instance, 0})) {
  }
}

LANCER_LANE bool enter_shape(const PlacedShape &shape, const Ray &ray, ObjectRay &object_ray) {
  double o[3], d[3];
  to_object_space(shape, ray, o, d);
  return enter_frame(shape.frame, o, d, object_ray);
}

// Transforms the ray to the scene's frame. Returns false for rays that by definition hit nothing: those with a non-finite
// value, a zero direction, an empty range or a NaN in the range.
LANCER_LANE bool enter_world(const PlacementFrame &world, const Ray &ray, ObjectRay &world_ray) {
  const double o[3] = {ray.o.x, ray.o.y, ray.o.z}, d[3] = {ray.d.x, ray.d.y, ray.d.z};
  return ray.tmin < ray.tmax && enter_frame(world, o, d, world_ray);
}

// Bounds on the box-frame parameter of every hit with parameter <= t (above) or >= t (below). t = t0 + tau unit was rounded
// once and t - t0 is rounded once here: together at most 2^-53 (|t| + |t - t0|) <= 2^-51 (|t| + |t0|). ray: has the t0 and
// inverse_unit of ObjectRay; scale: of its frame.
template <class D> LANCER_LANE D box_tau_above(const auto &ray, double scale, const D &t) {
  return ((t - ray.t0) + D(0x1p-51) * (abs(t) + abs(ray.t0))) * ray.inverse_unit * D(scale);
}
template <class D> LANCER_LANE D box_tau_below(const auto &ray, double scale, const D &t) {
  return ((t - ray.t0) - D(0x1p-51) * (abs(t) + abs(ray.t0))) * ray.inverse_unit * D(scale);
}

} // namespace lancer
