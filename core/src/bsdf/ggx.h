// The GGX distribution of microfacets, stretched along the frame's axes: density, masking, sampling of what is seen from wo.
#pragma once

#include "sampling/warp.h"
#include "simd/vectors.h"

namespace lancer {

// D: density of microfacet normals per solid angle. A sum of squares: no digit is lost for small roughness.
template <class F> LANCER_LANE F ggx_d(const Vec3<F> &h, F alpha_x, F alpha_y) {
  const F x = h.x / alpha_x, y = h.y / alpha_y, length2 = x * x + y * y + h.z * h.z;
  return kInvPi / (alpha_x * alpha_y * length2 * length2);
}

// The length of a direction's part along the surface after squeezing facets of that roughness to roughness 1.
template <class F> LANCER_LANE F squeezed(const Vec3<F> &w, F alpha_x, F alpha_y) {
  const F x = alpha_x * w.x, y = alpha_y * w.y;
  return sqrt(x * x + y * y);
}

// Facets hidden from w, as area: Smith's Lambda times |cos|, which no grazing direction sends to infinity.
template <class F> LANCER_LANE F ggx_hidden(const Vec3<F> &w, F alpha_x, F alpha_y) {
  const F along = squeezed(w, alpha_x, alpha_y), z = abs(w.z);
  const F all = z + sqrt(z * z + along * along);
  return select(all > 0.0f, 0.5f * along * (along / all), F(0.0f));
}

// A normal h visible from wo (wo.z > 0), density G1(wo) max(0, wo.h) D(h) / wo.z. Dupuy and Benyoub 2023: mirrored at facets of
// roughness 1, a view falls evenly on a cap of the sphere.
template <class F> LANCER_LANE Vec3<F> ggx_sample_visible(const Vec3<F> &wo, F alpha_x, F alpha_y, F u, F v) {
  const Vec3<F> w = normalize(Vec3<F>(alpha_x * wo.x, alpha_y * wo.y, wo.z));
  // 1 - cos of the angle on the cap, so that its apex keeps its digits.
  const F s = u * (1.0f + w.z);
  const F sin_theta = sqrt(max(F(0.0f), s * (2.0f - s)));
  const SinCos<F> phi = sin_cos_turn(v);
  const Vec3<F> h(sin_theta * phi.cos + w.x, sin_theta * phi.sin + w.y, (1.0f - u) * (1.0f + w.z));
  return normalize(Vec3<F>(alpha_x * h.x, alpha_y * h.y, h.z));
}

} // namespace lancer
