// The nodes of looking.h in lanes. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/looking.h"
#include "nodes/site.h"
#include "scene/geometry.h"

#include <cmath>

namespace lancer {
namespace {

template <class F> glm::vec3 lane_of(const Vector3<F> &v, int i) { return {lane(v.x, i), lane(v.y, i), lane(v.z, i)}; }

// Calls look(lane, place) in each lane and returns the vectors that it returns.
template <class F, class Look> Vector3<F> look_from(const Site<F> &site, const Look &look) {
  constexpr int width = Site<F>::kWidth;
  const LookingLanes &of = *site.looking;
  alignas(64) float numbers[3][width];
  for (int i = 0; i < width; ++i) {
    const int from = site.first + i;
    LookingPlace place;
    place.backfacing = lane(site.backfacing, i);
    Surface &surface = place.surface;
    surface.p = glm::dvec3(lane(site.p.x, i), lane(site.p.y, i), lane(site.p.z, i));
    surface.ng = place.facing(lane_of<F>(site.ng, i));
    surface.ns = place.facing(lane_of<F>(site.ns, i));
    surface.instance = site.number[i];
    surface.time = site.time[i];
    surface.primitive = site.primitive[i];
    surface.offset = of.offset[from];
    place.pixel = of.pixel[from];
    place.sample = of.sample[from];
    place.dimension = of.dimension[from];
    const glm::vec3 found = (of.used >> from & 1) != 0 ? look(i, place) : glm::vec3(0.0f);
    for (int k = 0; k < 3; ++k)
      numbers[k][i] = found[k];
  }
  return {load_lanes<width>(numbers[0]), load_lanes<width>(numbers[1]), load_lanes<width>(numbers[2])};
}

// Whether nodes may send rays here: not in heights of displacement, shadows, lamps and the world.
template <class F> bool can_look(const Site<F> &site) { return site.placed && site.looking; }

// Ambient Occlusion: the share of the surroundings that is open. flags 1: of those inside; 2: only its own object occludes.
template <class F> Value<F> occlusion_node(const Inputs<F> &in, const Site<F> &site, uint32_t number) {
  if (!can_look(site))
    return scalar(F(1.0f));
  const bool inside = (in.node.flags & 1) != 0, alone = (in.node.flags & 2) != 0;
  const Vector3<F> n = unit_or_zero(in.normal(1, site));
  const F distance = in.scalar(0);
  const double scale = site.user_scale();
  const Vector3<F> open = look_from<F>(site, [&](int i, const LookingPlace &place) {
    const glm::vec3 axis = lane_of<F>(n, i);
    const float reach = lane(distance, i);
    // A normal that is not finite has no direction.
    if (!(reach > 0.0f) || in.node.option == 0 || !(glm::dot(axis, axis) > 0.5f))
      return glm::vec3(1.0f);
    return glm::vec3(
        open_share(*site.looking->rays, place, inside ? -axis : axis, double(reach) * scale, in.node.option, alone, number));
  });
  return scalar(open.x);
}

// Bevel: the normal of rounded edges. Its difference from the surface's own is added to another normal, if one is given.
template <class F> Value<F> bevel_node(const Inputs<F> &in, const Site<F> &site, uint32_t number) {
  const Vector3<F> own = in.normal(2, site);
  if (!can_look(site))
    return solid(own);
  const F radius = in.scalar(0);
  const double scale = site.user_scale();
  const Vector3<F> rounded = look_from<F>(site, [&](int i, const LookingPlace &place) {
    const float reach = lane(radius, i);
    if (!(reach > 0.0f) || !std::isfinite(reach) || in.node.option == 0 || !(site.looking->sharp >> (site.first + i) & 1))
      return lane_of<F>(own, i);
    const glm::vec3 found = bevelled_normal(*site.looking->rays, place, double(reach) * scale, in.node.option, number);
    return found == glm::vec3(0.0f) ? lane_of<F>(own, i) : found;
  });
  const Parameter &given = in.node.inputs[1];
  if (!given.varies() && given.value == glm::vec3(0.0f))
    return solid(rounded);
  return solid(unit_or_zero(Vector3<F>(in[1] + (rounded - own))));
}

// Whether a ray can be sent along a direction of this length, which is in double.
inline bool is_way(double squared_length) { return squared_length > 0.0 && std::isfinite(squared_length); }

// Returns an attribute where a ray has met a surface. flags 2: its mean, or the first of two numbers; 4: its alpha.
inline glm::vec3 attribute_of_hit(const GeometryView &geometry, const Hit &hit, const Node &node) {
  const Instance &instance = geometry.instances[hit.instance];
  // An exact shape has no attributes.
  if (instance.kind != ShapeKind::Mesh)
    return glm::vec3(node.flags & 4 ? 1.0f : 0.0f);
  const MeshView &mesh = geometry.meshes[instance.mesh];
  const glm::vec4 value = attribute_at(mesh, node.name, hit.primitive, {hit.u, hit.v});
  if (node.flags & 4)
    return glm::vec3(value.w);
  if (!(node.flags & 2))
    return glm::vec3(value);
  const MeshAttribute *attribute = find_attribute(mesh, node.name);
  return glm::vec3(attribute && attribute->channels == 2 ? value.x : (value.x + value.y + value.z) / 3.0f);
}

// Raycast. option 0: whether it meets a surface, whether that is of its own object, and the distance; 1: the place; 2: the
// normal there; 3: an attribute there. flags 1: only its own object. moved: the site, which a bump may have moved from the
// place of the hit.
template <class F> Value<F> raycast_node(const Inputs<F> &in, const Site<F> &moved) {
  const F length_of_way = in.scalar(2), zero(0.0f);
  const Site<F> &site = moved.standing();
  if (!can_look(site))
    return in.node.option == 0 ? Value<F>{{zero, zero, length_of_way}, F(1.0f)} : solid(Vector3<F>(zero));
  const Vector3<F> start = in[0], way = in[1], here = narrow(user_position(site));
  const Vector3<DoubleOf<F>> from = from_user_world(site, widen(start));
  const double scale = site.user_scale();
  const DoubleOf<F> step = length(Vector3<DoubleOf<F>>(moved.p - site.p)) / DoubleOf<F>(scale);
  const bool alone = (in.node.flags & 1) != 0;
  return solid(look_from<F>(site, [&](int i, const LookingPlace &place) {
    const float reach = lane(length_of_way, i);
    const glm::vec3 o = lane_of<F>(start, i), d = lane_of<F>(way, i);
    const glm::dvec3 origin(lane(from.x, i), lane(from.y, i), lane(from.z, i)), along = glm::dvec3(d) * scale;
    const glm::vec3 missed = in.node.option == 0 ? glm::vec3(0.0f, 0.0f, reach) : glm::vec3(0.0f);
    if (!(reach > 0.0f) || !is_way(glm::dot(along, along)) || !std::isfinite(glm::dot(origin, origin)))
      return missed;
    // A ray from the place itself does not meet the triangle there. One from a place beside it, which a bump asks about, begins
    // beyond that step, as in Cycles.
    Ray ray = ray_from(place.surface, along, double(reach));
    ray.kinds = alone ? ~0u : uint32_t(RayKind::Raycast);
    ray.tmin = 1.1 * lane(step, i);
    if (o != lane_of<F>(here, i)) {
      ray.o = origin;
      ray.skip_instance = ray.skip_primitive = kNone;
    }
    const Hit hit = site.looking->rays->closest(ray, alone ? place.surface.instance : kNone);
    if (!hit.valid())
      return missed;
    if (in.node.option == 0)
      return glm::vec3(1.0f, hit.instance == place.surface.instance ? 1.0f : 0.0f, float(hit.t));
    if (in.node.option == 1)
      return o + d * float(hit.t);
    if (in.node.option == 3)
      return attribute_of_hit(*site.scene.geometry, hit, in.node);
    const Surface met = site.looking->rays->surface(ray, hit);
    return glm::dot(glm::dvec3(met.ng), ray.d) > 0.0 ? -met.ns : met.ns;
  }));
}

} // namespace
} // namespace lancer
