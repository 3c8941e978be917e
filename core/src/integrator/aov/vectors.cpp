#include "integrator/aov/vectors.h"

#include <cmath>
#include <limits>

namespace lancer {

namespace {

// Returns the place of a point in the picture, in pixels.
glm::dvec2 raster(const Camera &camera, const glm::dvec3 &p) {
  return camera.window_place(camera.to_local(p - camera.to_world.translation)) * glm::dvec2(camera.width, camera.height);
}

// Returns the place of a direction; that of a perspective camera times its depth, as Cycles compares it.
glm::dvec2 raster_of_direction(const Camera &camera, const glm::dvec3 &d) {
  const glm::dvec3 local = camera.to_local(d);
  const double depth = camera.kind == CameraKind::Perspective ? -local.z : 1.0;
  return camera.window_place(local) * depth * glm::dvec2(camera.width, camera.height);
}

void add(const glm::dvec2 &before, const glm::dvec2 &now, const glm::dvec2 &after, SampleResult &result) {
  const auto vector = glm::dvec4(before - now, now - after);
  // A point beside the camera has no place in the picture: it stands still. The film would drop the sample otherwise.
  for (int i = 0; i < 4; ++i)
    result.vector[i] = std::abs(vector[i]) <= double(std::numeric_limits<float>::max()) ? float(vector[i]) : 0.0f;
}

// Returns a place within a triangle at a moment, in object space.
glm::dvec3 point_at(const MeshView &mesh, const Surface &surface, uint32_t moment) {
  const std::span<const glm::vec3> positions =
      mesh.vector_positions.subspan(moment * mesh.positions.size(), mesh.positions.size());
  const glm::uvec3 &corners = mesh.triangles[surface.primitive];
  const glm::dvec2 &b = surface.bary;
  return (1.0 - b.x - b.y) * glm::dvec3(positions[corners.x]) + b.x * glm::dvec3(positions[corners.y]) +
         b.y * glm::dvec3(positions[corners.z]);
}

} // namespace

Vectors::Vectors(const Scene &scene, const Camera &camera, const IntegratorSettings &settings)
    : scene_(scene), camera_(camera), moments_(settings.moments && settings.moments->moves ? settings.moments : nullptr),
      wanted_((settings.passes & bit(Pass::Vector)) != 0), sky_(wanted_ && settings.sky_vectors) {}

void Vectors::record_surface(const Surface &surface, SampleResult &result) const {
  result.vector_weight = 1.0f;
  const Instance &instance = scene_.geometry.instances[surface.instance];
  const MeshView *const mesh = instance.kind == ShapeKind::Mesh ? &scene_.geometry.meshes[instance.mesh] : nullptr;
  const bool reshapes = mesh && !mesh->vector_positions.empty();
  const MomentPlaces *const places = scene_.vectors.find(surface.instance);
  if (!moments_ && !places && !reshapes)
    return;
  glm::dvec2 at[kMoments];
  for (uint32_t moment = 0; moment < kMoments; ++moment) {
    glm::dvec3 p = surface.p;
    if (places || reshapes) {
      const glm::dvec3 here = reshapes ? point_at(*mesh, surface, moment) : instance.to_object.point(p);
      p = (places ? (*places)[moment] : instance.to_world).point(here);
    }
    at[moment] = raster(moments_ ? moments_->cameras[moment] : camera_, p);
  }
  add(at[0], raster(camera_, surface.p), at[1], result);
}

void Vectors::record_direction(const glm::dvec3 &d, SampleResult &result) const {
  result.vector_weight = 1.0f;
  if (!moments_)
    return;
  // An orthographic camera, whose window has lengths, sees directions as long as the user's unit.
  const double length = camera_.kind == CameraKind::Orthographic ? scene_.normalisation.scale : 1.0;
  const glm::dvec3 there = length * glm::normalize(d);
  add(raster_of_direction(moments_->cameras[0], there), raster_of_direction(camera_, there),
      raster_of_direction(moments_->cameras[1], there), result);
}

bool sky_vectors_vary(const IntegratorSettings &settings) {
  return (settings.passes & bit(Pass::Vector)) && settings.sky_vectors && settings.moments && settings.moments->moves;
}

} // namespace lancer
