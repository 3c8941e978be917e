// The position of a hit in every frame that nodes use, and the attributes of meshes there. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/mesh_lanes.h"
#include "nodes/vector_nodes.h"
#include "scene/camera.h"
#include "scene/quadric_point.h"

namespace lancer {
namespace {

// Maps p so that the bounds of each lane's mesh become 0 ... 1.
template <class F> LANCER_LANE Vector3<DoubleOf<F>> in_bounds(const Site<F> &site, const Vector3<DoubleOf<F>> &p) {
  using D = DoubleOf<F>;
  const auto along = [&](int axis, const D &x) __attribute__((always_inline)) {
    const auto bound = [&](glm::vec3 MeshView::*which) __attribute__((always_inline)) {
      return by_lane<D>([&](int i) { return site.mesh[i] ? static_cast<double>((&(site.mesh[i]->*which).x)[axis]) : 0.0; });
    };
    const D low = bound(&MeshView::low), high = bound(&MeshView::high);
    // A flat mesh has coordinate 0.5 along an axis without extent.
    const D middle = D(0.5) * (low + high), size = high - low;
    return (x - middle) / select(size > D(0.0), size, D(1.0)) + D(0.5);
  };
  return {along(0, p.x), along(1, p.y), along(2, p.z)};
}

template <class F> Vector3<F> generated(const Site<F> &site, uint32_t name) {
  using D = DoubleOf<F>;
  if (!site.surface)
    return narrow(site.p);
  const Vector3<D> p = object_position(site);
  const Vector3<F> exact = narrow(Vector3<D>(D(0.5)) * p + Vector3<D>(D(0.5)));
  if (!any(site.on_mesh))
    return exact;
  const AttributeLanes<F> attribute = find_attributes(site, name);
  Vector3<F> r = select(site.on_mesh, narrow(in_bounds(site, p)), exact);
  if (any(attribute.found))
    r = select(attribute.found, attribute_at(site, attribute).v, r);
  return r;
}

template <class F> Vector3<F> uv(const Site<F> &site, uint32_t name) {
  using D = DoubleOf<F>;
  const F zero(0.0f);
  Vector3<F> r(zero);
  if (!site.placed)
    return r;
  if (any(site.on_mesh)) {
    const AttributeLanes<F> attribute = find_attributes(site, name);
    const CornerUVs<F> c = corner_uvs(site, attribute, name);
    const auto mixed = [&](const F(&of)[3]) __attribute__((always_inline)) {
      return select(c.found, interpolate_uv(widen(of[0]), widen(of[1]), widen(of[2]), site.bary[0], site.bary[1]), zero);
    };
    r.x = mixed(c.u);
    r.y = mixed(c.v);
    // An attribute without two channels is returned unchanged.
    const MaskOf<F> other = attribute.found & !c.found;
    if (any(other))
      r = select(other, attribute_at(site, attribute).v, r);
  }
  if (!all(site.on_mesh)) {
    const Vector3<D> p = object_position(site);
    float places[2][Site<F>::kWidth] = {};
    for (int i = 0; i < Site<F>::kWidth; ++i) {
      if (site.mesh[i])
        continue;
      const glm::dvec2 place = quadric_uv(site.instance[i]->kind, {lane(p.x, i), lane(p.y, i), lane(p.z, i)});
      places[0][i] = static_cast<float>(place.x);
      places[1][i] = static_cast<float>(place.y);
    }
    r.x = select(site.on_mesh, r.x, by_lane<F>([&](int i) { return places[0][i]; }));
    r.y = select(site.on_mesh, r.y, by_lane<F>([&](int i) { return places[1][i]; }));
  }
  return r;
}

template <class F> Vector3<F> object_space_normal(const Site<F> &site) {
  const Vector3<F> shading = normal_to_object(site, site.ns);
  if (!site.in_height || !any(site.on_mesh))
    return shading;
  // A bump evaluates neighbouring points, whose interpolated normals differ.
  const Vector3<F> n = interpolated_normal(site), unit = unit_or_zero(n);
  const Vector3<F> seen = select(site.backfacing, -unit, unit);
  return select(site.on_mesh, select(black(n), normal_to_object(site, site.ng), seen), shading);
}

// Evaluates a function of the camera lane by lane.
template <class F, class Function> Vector3<F> ask_camera(const Vector3<DoubleOf<F>> &p, const Function &f) {
  constexpr int width = LanesOf<F>::kWidth;
  alignas(64) float numbers[3][width];
  for (int i = 0; i < width; ++i) {
    const glm::vec3 v = f(i, glm::dvec3(lane(p.x, i), lane(p.y, i), lane(p.z, i)));
    numbers[0][i] = v.x;
    numbers[1][i] = v.y;
    numbers[2][i] = v.z;
  }
  return {load_lanes<width>(numbers[0]), load_lanes<width>(numbers[1]), load_lanes<width>(numbers[2])};
}

template <class F> Vector3<F> in_camera(const Site<F> &site) {
  const Camera *camera = site.scene.camera;
  if (!camera)
    return narrow(user_position(site));
  const double scale = site.user_scale();
  return ask_camera<F>(site.p, [&](int, const glm::dvec3 &p) {
    return site.surface ? glm::vec3(glm::dvec3(camera->to_camera(p)) / scale) : camera->direction_to_camera(p);
  });
}

// Returns the position in the camera's frame; a direction of the world is taken as a point of the user's world.
template <class F> Vector3<F> from_camera_place(const Site<F> &site) {
  const Camera *camera = site.scene.camera;
  if (!camera)
    return narrow(user_position(site));
  const double scale = site.user_scale();
  return ask_camera<F>(site.surface ? site.p : from_user_world(site, site.p),
                       [&](int, const glm::dvec3 &p) { return glm::vec3(glm::dvec3(camera->to_camera(p)) / scale); });
}

// Returns the point that represents a lane in the picture.
template <class F> glm::dvec3 seen_at(const Site<F> &site, int i, const glm::dvec3 &p) {
  const Camera &camera = *site.scene.camera;
  if (site.surface)
    return p;
  if (camera.kind != CameraKind::Orthographic)
    return camera.to_world.translation + p;
  // Camera rays of an orthographic camera all have the same direction, so the ray's origin represents the lane. For any other
  // ray, the direction is used as a point of the user's world, as in Cycles.
  if (site.eye[i])
    return *site.eye[i];
  return site.scene.normalisation ? site.scene.normalisation->to_normalised(p) : p;
}

template <class F> Vector3<F> window(const Site<F> &site) {
  const Camera *camera = site.scene.camera;
  if (!camera)
    return narrow(user_position(site));
  return ask_camera<F>(site.p, [&](int i, const glm::dvec3 &p) {
    const glm::vec3 place = camera->to_window(seen_at(site, i, p));
    // Directions perpendicular to the axis of a perspective camera have no place in the picture.
    return is_finite(place.x) && is_finite(place.y) ? place : glm::vec3(0.0f);
  });
}

template <class F> Value<F> coordinate_node(const Node &node, const Site<F> &site) {
  using D = DoubleOf<F>;
  const F zero(0.0f);
  switch (node.option) {
  case Coordinate::Generated:
    return solid(generated(site, node.name));
  case Coordinate::Normal:
    return solid(object_space_normal(node.flags & 1 ? site.standing() : site));
  case Coordinate::Uv:
    return solid(uv(site, node.name));
  case Coordinate::Object:
    return solid(narrow(node.flags & 1 ? rows_times(node.matrix, user_position(site), 1.0) : object_position(site)));
  case Coordinate::Camera:
    return solid(in_camera(site));
  case Coordinate::FromCamera:
    return solid(from_camera_place(site.standing()));
  case Coordinate::Window:
    return solid(window(site));
  case Coordinate::Reflection:
    return solid(site.surface ? F(F(2.0f) * dot(site.ns, site.wo)) * site.ns - site.wo : site.wo);
  case Coordinate::Position:
    return solid(narrow(user_position(site)));
  case Coordinate::ShadingNormal:
    return solid(site.ns);
  case Coordinate::TrueNormal:
    return solid(site.ng);
  case Coordinate::Incoming:
    return solid(site.wo);
  case Coordinate::Backfacing:
    return scalar(select(site.backfacing, F(1.0f), zero));
  case Coordinate::EdgeU:
  case Coordinate::EdgeV: {
    if (!site.surface || !any(site.on_mesh))
      return solid(Vector3<F>(zero));
    const Edges<F> edges = edges_of(site);
    const Vector3<D> edge = vector_to_world(site, node.option == Coordinate::EdgeU ? edges.first : edges.second);
    const Vector3<F> outwards = narrow(edge / D(site.user_scale()));
    return solid(select(site.on_mesh, select(site.backfacing, -outwards, outwards), Vector3<F>(zero)));
  }
  case Coordinate::Parametric:
    return solid(Vector3<F>(site.surface ? narrow(D(1.0) - site.bary[0] - site.bary[1]) : zero, narrow(site.bary[0]), zero));
  default:
    return solid(Vector3<F>(zero));
  }
}

template <class F> Value<F> attribute_node(const Node &node, const Site<F> &site) {
  Value<F> r = nothing<F>();
  if (node.flags & AttributeFlag::Opaque)
    r.alpha = F(1.0f);
  if (!any(site.on_mesh))
    return r;
  const AttributeLanes<F> attribute = find_attributes(site, node.name);
  if (any(attribute.found)) {
    Value<F> given = attribute_at(site, attribute);
    if (node.flags & AttributeFlag::First) {
      const auto two = by_lane<MaskOf<F>>([&](int i) { return attribute.of[i] && attribute.of[i]->channels == 2; });
      given.v = select(two, Vector3<F>(given.v.x), given.v);
    }
    r = select(attribute.found, given, r);
  }
  if (node.name != 0 || all(attribute.found))
    return r;
  // The mesh's own colours.
  const auto painted =
      by_lane<MaskOf<F>>([&](int i) { return site.mesh[i] && !attribute.of[i] && !site.mesh[i]->colors.empty(); });
  if (!any(painted))
    return r;
  Vector3<F> c[3];
  load_corners(
      site,
      [&](int i, glm::vec3(&at)[3]) {
        const std::span<const glm::vec3> colors = site.mesh[i]->colors;
        for (size_t corner = 0; corner < 3 && !colors.empty(); ++corner)
          at[corner] = colors[size_t(site.primitive[i]) * 3 + corner];
      },
      c);
  return select(painted, solid(interpolate(c[0], c[1], c[2], site.weights())), r);
}

} // namespace
} // namespace lancer
