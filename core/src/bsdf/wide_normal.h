// reflecting_normal() of many lanes. For kernels only, like simd/lanes.h.
#pragma once

#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// Lanes whose reflecting lobes want another normal than ns: one that sends the mirrored direction above the surface.
LANCER_LANE M bends(const V3 &wo, const V3 &ns, const V3 &ng) {
  const M flat = (ns.x == ng.x) & (ns.y == ng.y) & (ns.z == ng.z);
  const F cos_o = dot(wo, ng), least = min(F(0.9f) * cos_o, F(0.01f));
  const V3 mirrored = F(2.0f) * dot(ns, wo) * ns - wo;
  return (!flat) & !(dot(ng, mirrored) >= least);
}

} // namespace
} // namespace lancer
