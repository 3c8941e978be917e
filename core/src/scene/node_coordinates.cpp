// Where the ray has met the surface, in every frame that nodes know.
#include "accel/quadric.h"
#include "scene/attribute.h"
#include "scene/camera.h"
#include "scene/node_site.h"
#include "scene/scene.h"

#include <cmath>

namespace lancer {

namespace {

glm::dvec3 rows_times(const float m[12], const glm::dvec3 &v, double translation) {
  glm::dvec3 result;
  for (int row = 0; row < 3; ++row)
    result[row] = double(m[4 * row]) * v.x + double(m[4 * row + 1]) * v.y + double(m[4 * row + 2]) * v.z +
                  double(m[4 * row + 3]) * translation;
  return result;
}

// The user's world; for the world the direction itself.
glm::dvec3 position(const Site &site) {
  return site.surface() && site.context->normalisation ? site.context->normalisation->to_world(site.p) : site.p;
}

glm::dvec3 object_position(const Site &site) { return site.instance() ? site.instance()->to_object.point(site.p) : site.p; }

glm::vec3 generated(const Node &node, const Site &site) {
  if (!site.surface())
    return glm::vec3(site.p);
  const glm::dvec3 p = object_position(site);
  const Mesh *mesh = site.mesh();
  if (!mesh)
    return glm::vec3(0.5 * p + 0.5);
  if (const MeshAttribute *found = find_attribute(*mesh, node.name))
    return glm::vec3(attribute_at(*mesh, *found, site.surface()->primitive, site.bary));
  // A flat mesh is in the middle of what it has no extent in.
  const glm::dvec3 middle = 0.5 * (glm::dvec3(mesh->low) + glm::dvec3(mesh->high));
  glm::dvec3 size = glm::dvec3(mesh->high) - glm::dvec3(mesh->low);
  for (int i = 0; i < 3; ++i)
    size[i] = size[i] > 0.0 ? size[i] : 1.0;
  return glm::vec3((p - middle) / size + 0.5);
}

glm::vec3 uv(const Node &node, const Site &site) {
  const Mesh *mesh = site.mesh();
  if (!mesh)
    return site.instance() ? glm::vec3(glm::dvec3(quadric_uv(site.instance()->kind, object_position(site)), 0.0))
                           : glm::vec3(0.0f);
  return {uv_at(*mesh, node.name, site.surface()->primitive, site.bary), 0.0f};
}

glm::vec3 normal(const Site &site) {
  const Mesh *mesh = site.mesh();
  if (!mesh || !site.in_height)
    return site.normal_to_object(site.ns);
  // A bump looks at neighbours, whose interpolated normals differ.
  const glm::vec3 n = interpolated_normal(*mesh, site.instance()->shading, site.surface()->primitive, site.bary);
  if (n == glm::vec3(0.0f))
    return site.normal_to_object(site.ng);
  return site.backfacing ? -unit_or_zero(n) : unit_or_zero(n);
}

glm::vec3 camera(const Site &site) {
  const Camera *camera = site.context->camera;
  if (!camera)
    return glm::vec3(position(site));
  if (!site.surface())
    return camera->direction_to_camera(site.p);
  const double scale = site.context->normalisation ? site.context->normalisation->scale : 1.0;
  return glm::vec3(glm::dvec3(camera->to_camera(site.p)) / scale);
}

// The point that stands for a site in the picture.
glm::dvec3 seen_at(const Site &site, const Camera &camera) {
  if (site.surface())
    return site.p;
  if (camera.kind != CameraKind::Orthographic)
    return camera.to_world.translation + site.p;
  // All parallel rays look the same way: one of the camera's is where it starts; any other's direction is taken for a point of
  // the user's world, as Cycles has it.
  if (site.context->eye)
    return *site.context->eye;
  return site.context->normalisation ? site.context->normalisation->to_normalised(site.p) : site.p;
}

glm::vec3 window(const Site &site) {
  const Camera *camera = site.context->camera;
  if (!camera)
    return glm::vec3(position(site));
  const glm::vec3 place = camera->to_window(seen_at(site, *camera));
  // Nothing right beside a perspective camera has a place in its picture.
  return std::isfinite(place.x) && std::isfinite(place.y) ? place : glm::vec3(0.0f);
}

} // namespace

glm::vec4 coordinate(const Node &node, const Site &site) {
  switch (node.option) {
  case LANCER_COORDINATE_GENERATED:
    return solid(generated(node, site));
  case LANCER_COORDINATE_NORMAL:
    return solid(normal(site));
  case LANCER_COORDINATE_UV:
    return solid(uv(node, site));
  case LANCER_COORDINATE_OBJECT:
    return solid(glm::vec3(node.flags & 1 ? rows_times(node.matrix, position(site), 1.0) : object_position(site)));
  case LANCER_COORDINATE_CAMERA:
    return solid(camera(site));
  case LANCER_COORDINATE_WINDOW:
    return solid(window(site));
  case LANCER_COORDINATE_REFLECTION:
    if (!site.surface())
      return solid(site.context->wo);
    return solid(2.0f * glm::dot(site.ns, site.context->wo) * site.ns - site.context->wo);
  case LANCER_COORDINATE_POSITION:
    return solid(glm::vec3(position(site)));
  case LANCER_COORDINATE_SHADING_NORMAL:
    return solid(site.ns);
  case LANCER_COORDINATE_TRUE_NORMAL:
    return solid(site.ng);
  case LANCER_COORDINATE_INCOMING:
    return solid(site.context->wo);
  case LANCER_COORDINATE_BACKFACING:
    return scalar(site.backfacing ? 1.0f : 0.0f);
  case LANCER_COORDINATE_PARAMETRIC:
    return solid(glm::vec3(glm::dvec3(site.surface() ? 1.0 - site.bary.x - site.bary.y : 0.0, site.bary.x, 0.0)));
  default:
    return solid(glm::vec3(0.0f));
  }
}

glm::vec4 attribute(const Node &node, const Site &site) {
  const Mesh *mesh = site.mesh();
  if (!mesh)
    return glm::vec4(0.0f);
  const uint32_t triangle = site.surface()->primitive;
  if (const MeshAttribute *found = find_attribute(*mesh, node.name))
    return attribute_at(*mesh, *found, triangle, site.bary);
  if (node.name != 0 || mesh->colors.empty())
    return glm::vec4(0.0f);
  const glm::vec3 *corner = mesh->colors.data() + size_t(triangle) * 3;
  return solid(float(1.0 - site.bary.x - site.bary.y) * corner[0] + float(site.bary.x) * corner[1] +
               float(site.bary.y) * corner[2]);
}

glm::vec4 transform(const Inputs &in) {
  const glm::dvec3 v(in[0]);
  if (in.node.option == 2) {
    // Normals take the inverse transpose.
    glm::dmat3 m;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        m[column][row] = double(in.node.matrix[4 * row + column]);
    const double det = glm::determinant(m);
    return solid(det == 0.0 ? in[0] : unit_or_zero(glm::vec3(glm::transpose(glm::inverse(m)) * v)));
  }
  return solid(glm::vec3(rows_times(in.node.matrix, v, in.node.option == 0 ? 1.0 : 0.0)));
}

} // namespace lancer
