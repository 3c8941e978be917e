// Shadow rays near the shadow terminator of smooth meshes: they start on the curved surface that the normals describe, so that
// the triangles' own edges cast no shadow there. The method of Hanika, Hacking the Shadow Terminator (Ray Tracing Gems II, 4).
#pragma once

#include "lights/light.h"
#include "scene/geometry.h"
#include "scene/surface.h"
#include "simd/vectors.h"

namespace lancer {

// Returns the share of the full offset for a ray towards wi: it fades in as the light approaches grazing angles. limit:
// Instance::terminator.
template <class F> LANCER_LANE F terminator_amount(F limit, const Vec3<F> &n, const Vec3<F> &ng, const Vec3<F> &wi) {
  const F facing = dot(n, wi), cos_n = abs(facing), cos_g = dot(select(facing < 0.0f, -ng, ng), wi);
  const F amount = clamp01(select(cos_n < limit, 2.0f - (cos_g + cos_n) / limit, 1.0f - cos_g / limit));
  return select(limit > 0.0f, amount, F(0.0f));
}

// Returns the offset of the start of a ray towards the unit direction wi, in the normalised world; n: the shading normal, ng:
// the geometric one, both on the viewer's side. The offset is 0 if the mesh is not smooth or if wi is far from grazing.
glm::dvec3 terminator_offset(const GeometryView &geometry, const Surface &surface, const glm::vec3 &n, const glm::vec3 &ng,
                             const glm::vec3 &wi);

// Returns a shadow ray to a light's sample; ns, ng: the shading and the geometric normal, both on the viewer's side.
Ray shadow_ray(const GeometryView &geometry, const Surface &surface, const glm::vec3 &ns, const glm::vec3 &ng,
               const LightSample &sample);

} // namespace lancer
