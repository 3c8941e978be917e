// Which of many rays may run into a lamp: meet() without what follows from it. For kernels only, like simd/lanes.h.
#pragma once

#include "lights/wide_lamp.h"
#include "scene/light.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE D3 splat3(const double (&v)[3]) { return {D(v[0]), D(v[1]), D(v[2])}; }

// Lanes whose way from o along unit wi meets the lamp before end; suns have no distance.
LANCER_LANE M may_meet(const WideLamp &lamp, const D3 &o, const D3 &wi, D end) {
  const D zero(0.0), one(1.0);
  if (lamp.kind == static_cast<uint32_t>(LightKind::Sun)) {
    const D3 apart = wi - splat3(lamp.z);
    return D(0.5) * dot(apart, apart) <= D(lamp.one_minus_cos_sun);
  }
  const D3 to = splat3(lamp.position) - o;
  if (lamp.kind == static_cast<uint32_t>(LightKind::Area)) {
    // The plane of the area, then its sides.
    const D3 z = splat3(lamp.z);
    const D cosine = dot(wi, z), t = dot(to, z) / cosine;
    const D3 at = o + t * wi - splat3(lamp.position);
    const D x = dot(at, splat3(lamp.x)) / D(lamp.half_x), y = dot(at, splat3(lamp.y)) / D(lamp.half_y);
    return (cosine > zero) & (t > zero) & (t < end) & (abs(x) <= one) & (abs(y) <= one);
  }
  const D distance = sqrt(dot(to, to)), along = dot(to, wi), radius(lamp.radius);
  if (lamp.soft) {
    // The disk that faces o.
    const D cosine = along / distance, t = distance / cosine;
    const D3 miss = t * wi - to;
    return (cosine > zero) & (t < end) & (sqrt(dot(miss, miss)) <= radius);
  }
  const D3 miss = along * wi - to;
  return ((along > zero) & (sqrt(dot(miss, miss)) < radius)) | (distance <= radius);
}

} // namespace
} // namespace lancer
