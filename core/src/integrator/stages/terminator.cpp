#include "integrator/stages/terminator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lancer {

namespace {

struct SmoothTriangle {
  glm::dvec3 v[3], n[3]; // object space
};

// Returns false where the triangle has no smooth normals.
bool read_triangle(const MeshView &mesh, const Instance &instance, uint32_t triangle, float time, SmoothTriangle &smooth) {
  glm::vec3 n[3];
  if (!corner_normals(mesh, instance.shading, triangle, time, n))
    return false;
  for (int i = 0; i < 3; ++i) {
    smooth.v[i] = glm::dvec3(mesh.vertex(triangle, i, time));
    smooth.n[i] = glm::dvec3(n[i]);
  }
  // A flat face among smooth faces has the same normal at all corners.
  return smooth.n[0] != smooth.n[1] || smooth.n[1] != smooth.n[2];
}

// Returns the height of the tangent plane at corner i above p, times sign, at least 0. The plane is raised until it is above
// the other corners.
double plane_above(const SmoothTriangle &t, int i, const glm::dvec3 &p, double sign) {
  double raised = 0.0;
  for (int k = 0; k < 3; ++k)
    raised = std::max(raised, sign * glm::dot(t.v[k] - t.v[i], t.n[i]));
  return std::max(0.0, sign * glm::dot(t.v[i] - p, t.n[i]) + raised);
}

// Returns the height of the curved surface over the triangle at barycentrics b, along the interpolated normal.
double height(const SmoothTriangle &t, const glm::dvec3 &b, const glm::dvec3 &p, bool outwards) {
  // A paraboloid whose slope changes between the corners as the normals do.
  const double e02 = glm::dot(t.n[2] - t.n[0], t.v[0] - t.v[2]), e12 = glm::dot(t.n[2] - t.n[1], t.v[1] - t.v[2]);
  const double e01 = glm::dot(t.n[1] - t.n[0], t.v[1] - t.v[0]);
  const double bulge = e02 * b.x * (b.x - 1.0) + (e02 + e12 + e01) * b.x * b.y + e12 * b.y * (b.y - 1.0);
  // At least the lowest of the corners' tangent planes.
  const double sign = outwards ? 1.0 : -1.0;
  const double planes = std::min({plane_above(t, 0, p, sign), plane_above(t, 1, p, sign), plane_above(t, 2, p, sign)});
  return sign * std::max(planes, sign * 0.5 * bulge);
}

} // namespace

glm::dvec3 terminator_offset(const GeometryView &geometry, const Surface &surface, const glm::vec3 &n, const glm::vec3 &ng,
                             const glm::vec3 &wi) {
  const Instance &still = geometry.instances[surface.instance];
  if (still.kind != ShapeKind::Mesh)
    return glm::dvec3(0.0);
  const float amount = terminator_amount(still.terminator, n, ng, wi);
  SmoothTriangle triangle;
  if (!(amount > 0.0f) || !read_triangle(geometry.meshes[still.mesh], still, surface.primitive, surface.time, triangle))
    return glm::dvec3(0.0);
  Instance moved;
  const Instance &instance = geometry.placed_at(surface.instance, surface.time, moved);
  const glm::dvec3 b(1.0 - surface.bary.x - surface.bary.y, surface.bary.x, surface.bary.y);
  const glm::dvec3 p = b.x * triangle.v[0] + b.y * triangle.v[1] + b.z * triangle.v[2];
  const glm::dvec3 lift = b.x * triangle.n[0] + b.y * triangle.n[1] + b.z * triangle.n[2];
  const bool outwards = glm::dot(instance.to_world.vector(lift), glm::dvec3(glm::dot(n, wi) < 0.0f ? -ng : ng)) > 0.0;
  return double(amount) * instance.to_world.vector(lift * height(triangle, b, p, outwards));
}

Ray shadow_ray(const GeometryView &geometry, const Surface &surface, const glm::vec3 &ns, const glm::vec3 &ng,
               const LightSample &sample) {
  const bool far = std::isinf(sample.distance);
  const glm::vec3 wi(sample.wi);
  Ray ray = ray_from(surface, sample.wi, far ? std::numeric_limits<double>::infinity() : 1.0);
  const glm::dvec3 lift = terminator_offset(geometry, surface, ns, ng, wi);
  if (lift != glm::dvec3(0.0)) {
    // A ray from below the triangle's own plane may hit the triangle; one from above cannot.
    ray.o = surface.p + lift;
    if (!((glm::dot(wi, ng) > 0.0f) == (glm::dot(wi, ns) > 0.0f)))
      ray.skip_instance = ray.skip_primitive = kNone;
  }
  if (!far)
    ray.d = sample.target - ray.o;
  ray.kinds = RayKind::Shadow;
  return ray;
}

} // namespace lancer
