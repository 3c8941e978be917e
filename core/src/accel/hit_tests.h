// Tests of rays against primitives: triangles, watertight (Woop, Benthin, Wald 2013) and in double, where one triangle and
// several in lanes give the same bits; and one primitive at a time, of any kind, for traversals that keep the closer hit.
#pragma once

#include "accel/placed_shape.h"
#include "scene/geometry.h"
#include "scene/quadric_point.h"
#include "scene/ray.h"

namespace lancer {

// Returns a b - product for the rounded product, exactly, by Veltkamp's splitting.
LANCER_LANE double rest_of_product(double a, double b, double product) {
  const double sa = 134217729.0 * a, sb = 134217729.0 * b;
  const double high_a = sa - (sa - a), high_b = sb - (sb - b), low_a = a - high_a, low_b = b - high_b;
  return ((high_a * high_b - product) + high_a * low_b + low_a * high_b) + low_a * low_b;
}

// Returns a b - c d, accurate to its last digit.
LANCER_LANE double difference_of_products(double a, double b, double c, double d) {
  const double p = a * b, q = c * d;
  return (p - q) + (rest_of_product(a, b, p) - rest_of_product(c, d, q));
}

// Returns whether the origin lies within a triangle with the corners (x, y) of which some edge functions w have rounded to
// zero. w[i] = x[k] y[j] - y[k] x[j], where j and k are the corners after i. Recomputes these edge functions to their last
// digit. An origin exactly on an edge is moved by an infinitesimal towards +x, and by a second-order infinitesimal towards +y.
// The move is the same for every triangle, so a line through an edge or a corner hits exactly one of the triangles around it
// for each crossing of their surface.
LANCER_LANE bool within_edges(const double x[3], const double y[3], double w[3]) {
  int sides = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1, k = j == 2 ? 0 : j + 1;
    // Recompute an edge function that has rounded to zero: it is the difference of the rounding errors of both products.
    if (w[i] == 0.0)
      w[i] = difference_of_products(x[k], y[j], y[k], x[j]);
    const double side = w[i] != 0.0 ? w[i] : y[k] != y[j] ? y[k] - y[j] : x[j] - x[k];
    sides += (side > 0.0) - (side < 0.0);
  }
  return sides == 3 || sides == -3;
}

// Returns a + b + c with the same bits for any order of the three.
template <class D> LANCER_LANE D sum_in_any_order(const D &a, const D &b, const D &c) {
  const D low = min(b, a), high = max(b, a);
  return (min(c, low) + max(c, high)) + max(min(c, high), low);
}

// The axes of a ray: kz is the axis of its direction's largest component.
struct RayAxes {
  uint32_t kx, ky, kz;
};
LANCER_LANE RayAxes axes_from(uint32_t kz) {
  const uint32_t kx = kz == 2 ? 0 : kz + 1;
  return {kx, kx == 2 ? 0 : kx + 1, kz};
}
LANCER_LANE uint32_t longest_axis(const double d[3]) {
  const double x = abs(d[0]), y = abs(d[1]), z = abs(d[2]);
  return z >= x && z >= y ? 2 : (y >= x ? 1 : 0);
}

// A ray with its axes in the order kx, ky, kz: the shear maps the ray to the axis z = 1 through the origin.
template <class D> struct ShearedRay {
  D o[3];
  D shear[2], upright; // direction over its component along kz; one over this component
  D t0, unit;          // of ObjectRay
};
LANCER_LANE ShearedRay<double> shear_ray(const ObjectRay &ray, const RayAxes &k) {
  const double up = ray.d[k.kz];
  return {{ray.o[k.kx], ray.o[k.ky], ray.o[k.kz]}, {ray.d[k.kx] / up, ray.d[k.ky] / up}, 1.0 / up, ray.t0, ray.unit};
}

// Hit of a ray on a triangle: its parameter, with the same bits for any order of the corners; the weights of corners 1 and 2
// are wb / det and wc / det.
template <class D> struct TriangleHit { D t, wb, wc, det; };

namespace {

// Resolves the ties, which are rare: the lanes whose ray passes exactly through an edge, by within_edges(). Returns met without
// the lanes that miss.
template <class D>
[[gnu::noinline, gnu::cold]] uint32_t settle_ties(const D (&x)[3], const D (&y)[3], uint32_t ties, uint32_t met, D (&w)[3]) {
  constexpr size_t count = sizeof(D) / sizeof(double);
  alignas(64) double corner_x[3][count], corner_y[3][count], edge[3][count];
  for (int i = 0; i < 3; ++i) {
    store(corner_x[i], x[i]);
    store(corner_y[i], y[i]);
    store(edge[i], w[i]);
  }
  for (; ties != 0; ties &= ties - 1) {
    const int lane = __builtin_ctz(ties);
    const double lane_x[3] = {corner_x[0][lane], corner_x[1][lane], corner_x[2][lane]};
    const double lane_y[3] = {corner_y[0][lane], corner_y[1][lane], corner_y[2][lane]};
    double lane_w[3] = {edge[0][lane], edge[1][lane], edge[2][lane]};
    if (!within_edges(lane_x, lane_y, lane_w))
      met &= ~(1u << lane);
    for (int i = 0; i < 3; ++i)
      edge[i][lane] = lane_w[i];
  }
  for (int i = 0; i < 3; ++i)
    w[i] = load_doubles<count>(edge[i]);
  return met;
}

} // namespace

// Tests each lane's line against its triangle; bit i of the result: lane i hits. corner: by number, and by axis in the ray's
// order. Swapping the corners of an edge negates its edge function exactly, so exactly one of the triangles at a shared edge is
// hit.
template <class D>
LANCER_LANE uint32_t intersect_triangle(const D (&corner)[3][3], const ShearedRay<D> &ray, TriangleHit<D> &hit) {
  // Shear the corners into the ray's frame.
  D x[3], y[3], z[3];
  for (int i = 0; i < 3; ++i) {
    z[i] = corner[i][2] - ray.o[2];
    x[i] = (corner[i][0] - ray.o[0]) - ray.shear[0] * z[i];
    y[i] = (corner[i][1] - ray.o[1]) - ray.shear[1] * z[i];
  }
  // Keep the triangle if the origin lies on one side of all three edges.
  const D zero(0.0);
  D w[3] = {x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]};
  uint32_t met = bits(((w[0] >= zero) & (w[1] >= zero) & (w[2] >= zero)) | ((w[0] <= zero) & (w[1] <= zero) & (w[2] <= zero)));
  if (met == 0)
    return 0;
  if (const uint32_t ties = met & bits(w[0] * w[1] * w[2] == zero); ties != 0)
    met = settle_ties(x, y, ties, met, w);
  // Interpolate the depth and return to the parameter of the world ray.
  const D det = sum_in_any_order(w[0], w[1], w[2]);
  const D depth = sum_in_any_order(w[0] * (ray.upright * z[0]), w[1] * (ray.upright * z[1]), w[2] * (ray.upright * z[2]));
  hit = {ray.t0 + (depth / det) * ray.unit, w[1], w[2], det};
  return met;
}

// Returns whether a hit of a ray counts; without a filter every hit does.
struct Counting {
  HitFilter *filter = nullptr;
  size_t ray = 0; // number in its batch

  bool operator()(const Hit &hit) const { return !filter || !filter->instances[hit.instance] || filter->counts(ray, hit); }
};

inline void try_triangle(const Ray &ray, const RayAxes &axes, const ShearedRay<double> &sheared, const MeshView &mesh,
                         uint32_t instance, uint32_t triangle, const Counting &counting, Hit &best) {
  if (ray.skip_instance == instance && ray.skip_primitive == triangle)
    return;
  double corner[3][3];
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 p = mesh.vertex(triangle, i, ray.time);
    corner[i][0] = p[static_cast<int>(axes.kx)];
    corner[i][1] = p[static_cast<int>(axes.ky)];
    corner[i][2] = p[static_cast<int>(axes.kz)];
  }
  TriangleHit<double> met;
  if (!intersect_triangle(corner, sheared, met) || !(ray.tmin < met.t && met.t < ray.tmax) ||
      !closer(met.t, instance, triangle, best))
    return;
  if (const Hit hit{met.t, met.wb / met.det, met.wc / met.det, instance, triangle}; counting(hit))
    best = hit;
}

inline void try_quadric(const Ray &ray, const PlacedShape &shape, uint32_t instance, const Counting &counting, Hit &best) {
  try_places(
      instance, ray.tmin, best, [&](double &t) { return next_place(shape, instance, ray, t); },
      [&](const Hit &hit) {
        if (!counting(hit))
          return false;
        best = hit;
        return true;
      });
}

} // namespace lancer
