// Nodes of spaces and edges: vectors between the frames of world, object and camera, and the edges of triangles. Internal
// linkage, as in lanes.h.
#pragma once

#include "nodes/coordinate_nodes.h"

namespace lancer {
namespace {

// Kinds of vectors of TRANSFORM and VECTOR_TRANSFORM.
enum : uint32_t { kIsPoint = 0, kIsVector = 1, kIsNormal = 2 };

// Returns the vector in the user's world, given in the frame of the object or the camera, or the reverse.
template <class F> Vector3<F> from_object(const Site<F> &site, uint32_t kind, const Vector3<F> &v) {
  using D = DoubleOf<F>;
  if (!site.placed)
    return v;
  if (kind == kIsNormal)
    return normal_to_world(site, v);
  const Vector3<D> there = vector_to_world(site, widen(v));
  if (kind == kIsVector)
    return narrow(there / D(site.user_scale()));
  return narrow(in_user_world(site, there + translation_of(site, &Instance::to_world)));
}
template <class F> Vector3<F> to_object(const Site<F> &site, uint32_t kind, const Vector3<F> &v) {
  using D = DoubleOf<F>;
  if (!site.placed)
    return v;
  if (kind == kIsNormal)
    return normal_to_object(site, v);
  if (kind == kIsVector)
    return narrow(vector_to_object(site, widen(v) * D(site.user_scale())));
  return narrow(vector_to_object(site, from_user_world(site, widen(v))) + translation_of(site, &Instance::to_object));
}
// of_point, of_direction: the maps of a camera.
template <class F, class OfPoint, class OfDirection>
Vector3<F> by_camera(const Site<F> &site, uint32_t kind, const Vector3<F> &v, const OfPoint &of_point,
                     const OfDirection &of_direction) {
  const Camera *camera = site.scene.camera;
  if (!camera)
    return v;
  const Vector3<F> there = ask_camera<F>(
      widen(v), [&](int, const glm::dvec3 &p) { return kind == kIsPoint ? of_point(*camera, p) : of_direction(*camera, p); });
  return kind == kIsNormal ? unit_or_zero(there) : there;
}
template <class F> Vector3<F> from_camera(const Site<F> &site, uint32_t kind, const Vector3<F> &v) {
  const auto of_point = [&](const Camera &camera, const glm::dvec3 &p) {
    const glm::dvec3 place = camera.direction_from_camera(p * site.user_scale()) + camera.to_world.translation;
    return glm::vec3(site.scene.normalisation ? site.scene.normalisation->to_world(place) : place);
  };
  return by_camera(site, kind, v, of_point,
                   [](const Camera &camera, const glm::dvec3 &d) { return glm::vec3(camera.direction_from_camera(d)); });
}
template <class F> Vector3<F> to_camera(const Site<F> &site, uint32_t kind, const Vector3<F> &v) {
  const auto of_point = [&](const Camera &camera, const glm::dvec3 &p) {
    const glm::dvec3 place = site.scene.normalisation ? site.scene.normalisation->to_normalised(p) : p;
    return glm::vec3(glm::dvec3(camera.to_camera(place)) / site.user_scale());
  };
  return by_camera(site, kind, v, of_point,
                   [](const Camera &camera, const glm::dvec3 &d) { return camera.direction_to_camera(d); });
}

template <class F> Value<F> vector_transform_node(const Inputs<F> &in, const Site<F> &site) {
  const uint32_t kind = in.node.option, from = in.node.flags & 3, to = in.node.flags >> 2;
  Vector3<F> v = in[0];
  if (from == to)
    return solid(v);
  if (from != Space::World)
    v = from == Space::Object ? from_object(site, kind, v) : from_camera(site, kind, v);
  if (to != Space::World)
    v = to == Space::Object ? to_object(site, kind, v) : to_camera(site, kind, v);
  return solid(v);
}

// Returns the factor from the footprint of the picture's middle to that of a camera ray's pixel; 1 for other rays.
template <class F> F spread_of_pixel(const Site<F> &site) {
  const Camera *camera = site.scene.camera;
  const auto seen = !equal(site.path.kinds & WordOf<F>(uint32_t(RayKind::Camera)), WordOf<F>(0u));
  if (!camera || !any(seen))
    return F(1.0f);
  const Vector3<F> found =
      ask_camera<F>(widen(-site.wo), [&](int, const glm::dvec3 &d) { return glm::vec3(float(relative_spread(*camera, d))); });
  return select(seen, found.x, F(1.0f));
}

// The Wireframe node: whether the place is within half the width of an edge of its triangle.
template <class F> Value<F> wireframe_node(const Inputs<F> &in, const Site<F> &site) {
  using D = DoubleOf<F>;
  const F zero(0.0f);
  if (!any(site.on_mesh))
    return scalar(zero);
  D width = widen(in.scalar(0)) * D(0.5);
  if (in.node.flags & 1) {
    // The pixel's footprint along two directions of the surface, seen by the viewer.
    const Vector3<F> x = unit_or_zero(across(site.ng)), y = cross(site.ng, x);
    const auto seen = [&](const Vector3<F> &d) { return length(Vector3<F>(d - F(dot(d, site.wo)) * site.wo)); };
    width = width * widen(site.footprint * F(0.5f) * (seen(x) + seen(y)) * spread_of_pixel(site));
  } else {
    width = width * D(site.user_scale());
  }
  const Edges<F> edges = edges_of(site);
  const Vector3<D> e1 = vector_to_world(site, edges.first), e2 = vector_to_world(site, edges.second), e3 = e2 - e1;
  const Vector3<D> p = site.bary[0] * e1 + site.bary[1] * e2;
  const auto is_near = [&](const Vector3<D> &edge, const Vector3<D> &way) {
    const Vector3<D> area = cross(edge, way);
    return dot(area, area) < dot(edge, edge) * (width * width);
  };
  const auto on_edge = is_near(e1, p) | is_near(e2, p) | is_near(e3, Vector3<D>(p - e1));
  return scalar(select(site.on_mesh, narrow(select(on_edge, D(1.0), D(0.0))), zero));
}

} // namespace
} // namespace lancer
