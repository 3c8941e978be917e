// Tests of the wide BVH's blocks: four triangles or four spheres with one ray, and four triangles with as many rays as fit in
// registers. Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/enter.h"
#include "accel/roots.h"

namespace lancer {
namespace {

// Rays tested at a time against four triangles, and the resulting number of lanes.
constexpr int kTogether = kLanes >= 8 ? 2 : 1;
constexpr int kPairs = 4 * kTogether;

// Hits of lanes on triangles.
template <int W> struct alignas(64) BlockHits {
  double t[W], wb[W], wc[W], det[W];

  LANCER_LANE void record(const TriangleHit<Double<W>> &hit) {
    store(t, hit.t);
    store(wb, hit.wb);
    store(wc, hit.wc);
    store(det, hit.det);
  }
};

// Tests four triangles; bit i of the result: triangle i is hit with tmin < t < tmax and t <= limit.
LANCER_LANE uint32_t intersect_block(const TriangleBlock &block, const MeshRay &s, double tmin, double tmax, double limit,
                                     BlockHits<4> &hits) {
  using Four = Double<4>;
  const RayAxes &k = s.axes;
  Four corner[3][3];
  for (int i = 0; i < 3; ++i) {
    corner[i][0] = load_widened(block.corner[i][k.kx]);
    corner[i][1] = load_widened(block.corner[i][k.ky]);
    corner[i][2] = load_widened(block.corner[i][k.kz]);
  }
  const ShearedRay<Four> ray{{s.o[k.kx], s.o[k.ky], s.o[k.kz]}, {s.shear[k.kx], s.shear[k.ky]}, s.shear[3], s.t0, s.unit};
  TriangleHit<Four> hit;
  uint32_t met = intersect_triangle(corner, ray, hit);
  if (met == 0)
    return 0;
  hits.record(hit);
  for (uint32_t rest = met; rest != 0; rest &= rest - 1) {
    const int i = __builtin_ctz(rest);
    const double t = hits.t[i];
    if (!(tmin < t && t < tmax && t <= limit))
      met &= ~(1u << i);
  }
  return met;
}

// Tests four triangles with kTogether lanes whose directions have the same longest axis; corner: the triangles' corners,
// repeated for each lane. Bit 4 k + i of the result: the lane lanes[k] hits triangle i with tmin < t < tmax and t <= limit.
LANCER_LANE uint32_t intersect_together(const Double<kPairs> (&corner)[3][3], const PacketRays &r, uint32_t longest,
                                        const uint32_t (&lanes)[kTogether], const Entering &e, const double *limit,
                                        BlockHits<kPairs> &hits) {
  using Pairs = Double<kPairs>;
  const auto of = [&](const double *p) __attribute__((always_inline)) { return four_of_each(p, lanes); };
  const RayAxes k = axes_from(longest);
  const ShearedRay<Pairs> ray{{of(r.o[k.kx]), of(r.o[k.ky]), of(r.o[k.kz])},
                              {of(r.shear[k.kx]), of(r.shear[k.ky])},
                              of(r.upright),
                              of(r.t0),
                              of(r.unit)};
  TriangleHit<Pairs> hit;
  const uint32_t met = intersect_triangle(corner, ray, hit);
  if (met == 0)
    return 0;
  hits.record(hit);
  return met & bits((of(e.tmin) < hit.t) & (hit.t < of(e.tmax)) & (hit.t <= of(limit)));
}

// Four spheres and a ray: SphereTerms with the square root of the discriminant, in units of the scaled direction.
struct BlockRoots {
  alignas(32) double a[4], b[4], c[4], root[4], unit[4];
};

// Tests four spheres; bit i of the result: the ray's line hits sphere i.
LANCER_LANE uint32_t intersect_spheres(const SphereBlock &block, const Ray &ray, BlockRoots &roots) {
  using Four = Double<4>;
  // Transform the ray to the four unit spaces.
  Four o[3], d[3], unit, inverse_unit;
  to_object_space(
      [&](int column, int row) __attribute__((always_inline)) { return load_doubles<4>(block.to_object[column][row]); }, ray, o,
      d);
  const uint32_t usable = bits(scale_direction(d, unit, inverse_unit));
  SphereTerms<Four> terms;
  terms.find_discriminant(o, d);
  const uint32_t met = usable & bits(terms.discriminant >= Four(0.0));
  if (met == 0)
    return 0;
  terms.find_rest(o, d);
  store(roots.a, terms.a);
  store(roots.b, terms.b);
  store(roots.c, terms.c);
  store(roots.root, sqrt(terms.discriminant));
  store(roots.unit, unit);
  return met;
}

// intersect_quadric() for sphere i, once intersect_spheres() has set its bit.
LANCER_LANE bool choose_root(const BlockRoots &r, int i, double slack, bool leaves, double tmin, double tmax, double &t) {
  Interval interval;
  return sphere_interval(r.a[i], r.b[i], r.c[i], r.root[i], 4.0 * slack, interval) &&
         first_place(interval, r.unit[i], leaves, tmin, tmax, t);
}

} // namespace
} // namespace lancer
