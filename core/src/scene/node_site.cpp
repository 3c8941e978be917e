#include "scene/node_site.h"

namespace lancer {

namespace {

// The weights of vertex 1 and 2 that an offset in the triangle's plane adds.
glm::dvec2 bary_offset(const Instance &instance, const Mesh &mesh, uint32_t triangle, const glm::dvec3 &offset) {
  const glm::dvec3 v0(mesh.vertex(triangle, 0));
  const glm::dvec3 e1 = instance.to_world.vector(glm::dvec3(mesh.vertex(triangle, 1)) - v0);
  const glm::dvec3 e2 = instance.to_world.vector(glm::dvec3(mesh.vertex(triangle, 2)) - v0);
  const double g11 = glm::dot(e1, e1), g12 = glm::dot(e1, e2), g22 = glm::dot(e2, e2), det = g11 * g22 - g12 * g12;
  if (!(det > 0.0))
    return glm::dvec2(0.0);
  const double d1 = glm::dot(e1, offset), d2 = glm::dot(e2, offset);
  return {(g22 * d1 - g12 * d2) / det, (g11 * d2 - g12 * d1) / det};
}

} // namespace

Site::Site(const NodeContext &given) : context(&given) {
  if (!given.surface) {
    // All that the world knows is the direction; its surface would look back at the viewer.
    p = -glm::dvec3(given.wo);
    ns = ng = given.wo;
    return;
  }
  const Surface &surface = *given.surface;
  p = surface.p;
  bary = surface.bary;
  backfacing = glm::dot(surface.ng, given.wo) < 0.0f;
  ns = backfacing ? -surface.ns : surface.ns;
  ng = backfacing ? -surface.ng : surface.ng;
}

Site Site::moved(const glm::dvec3 &offset) const {
  Site site = *this;
  site.p += offset;
  // What is painted on a mesh goes the other way on a face that is seen from behind, as in Cycles: there the derivatives of
  // the parametrisation are turned together with the normal.
  if (mesh())
    site.bary += bary_offset(*instance(), *mesh(), surface()->primitive, backfacing ? -offset : offset);
  return site;
}

const Instance *Site::instance() const {
  return surface() && context->geometry ? &context->geometry->instances[surface()->instance] : nullptr;
}

const Mesh *Site::mesh() const {
  const Instance *placed = instance();
  return placed && placed->kind == ShapeKind::Mesh ? &context->geometry->meshes[placed->mesh] : nullptr;
}

glm::vec3 Site::normal_to_object(const glm::vec3 &n) const {
  return instance() ? carried_normal(instance()->to_world, glm::dvec3(n)) : n;
}

glm::vec3 Site::normal_to_world(const glm::vec3 &n) const {
  return instance() ? carried_normal(instance()->to_object, glm::dvec3(n)) : n;
}

} // namespace lancer
