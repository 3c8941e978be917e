// Normals and functions of them: normal maps, tangents, displacement, Fresnel and layer weight. Internal linkage, as in
// lanes.h.
#pragma once

#include "bsdf/fresnel.h"
#include "nodes/coordinate_nodes.h"

namespace lancer {
namespace {

// A tangent in object space and the handedness of its frame.
template <class F> struct Tangent {
  Vector3<F> t;
  F sign;
  MaskOf<F> found;
};

// Outward, of any length: normal maps use the interpolated frame without normalising it.
template <class F> Vector3<F> object_normal(const Site<F> &site) {
  const auto outward = [&](const Vector3<F> &n) { return normal_to_object(site, select(site.backfacing, -n, n)); };
  if (!any(site.on_mesh))
    return outward(site.ns);
  const Vector3<F> n = interpolated_normal(site);
  const auto flat = black(n);
  Vector3<F> r = n;
  if (any(flat))
    r = select(flat, outward(site.ng), r);
  return all(site.on_mesh) ? r : select(site.on_mesh, r, outward(site.ns));
}

// Returns the direction of growing u on a triangle.
template <class F> Tangent<F> uv_tangent(const Site<F> &site, uint32_t name, const Vector3<F> &n) {
  using D = DoubleOf<F>;
  const CornerUVs<F> uv = corner_uvs(site, find_attributes(site, name), name);
  const Edges<F> e = edges_of(site);
  const auto difference = [&](const F(&of)[3], int corner) { return D(widen(of[corner]) - widen(of[0])); };
  const D u1 = difference(uv.u, 1), v1 = difference(uv.v, 1), u2 = difference(uv.u, 2), v2 = difference(uv.v, 2);
  const D zero(0.0), det = u1 * v2 - v1 * u2, hand = select(det < zero, D(-1.0), D(1.0));
  // Project out the normal.
  Vector3<D> t = hand * (v2 * e.first - v1 * e.second);
  const Vector3<D> normal = widen(unit_or_zero(n));
  t = t - D(dot(t, normal)) * normal;
  const D size = length(t);
  const MaskOf<F> found = uv.found & (det != zero) & (size > zero);
  return {narrow(t / size), narrow(hand), found};
}

template <class F> Tangent<F> tangent_at(const Node &node, const Site<F> &site, const Vector3<F> &n) {
  using D = DoubleOf<F>;
  using M = MaskOf<F>;
  const F zero(0.0f), one(1.0f);
  if (!site.placed)
    return {Vector3<F>(zero), one, uniform<F>(false)};
  Tangent<F> r{Vector3<F>(zero), one, uniform<F>(false)};
  if (any(site.on_mesh)) {
    const AttributeLanes<F> attribute = find_attributes(site, node.tangent);
    if (!all(attribute.found))
      r = uv_tangent(site, node.name, n);
    if (any(attribute.found)) {
      const Value<F> given = attribute_at(site, attribute);
      r.t = select(attribute.found, given.v, r.t);
      r.sign = select(attribute.found, select(given.alpha < zero, F(-1.0f), one), r.sign);
      r.found = r.found | attribute.found;
    }
  }
  if (!all(site.on_mesh)) {
    // On exact surfaces, the tangent runs around the axis; on a plane, along x.
    const Vector3<D> p = object_position(site);
    const Vector3<F> around = unit_or_zero(narrow(Vector3<D>(-p.y, p.x, D(0.0))));
    const M plane = by_lane<M>([&](int i) { return site.instance[i]->kind == ShapeKind::Plane; });
    r.t = select(site.on_mesh, r.t, select(plane, Vector3<F>(one, zero, zero), around));
    r.sign = select(site.on_mesh, r.sign, one);
    r.found = (site.on_mesh & r.found) | ((!site.on_mesh) & (plane | !black(around)));
  }
  return r;
}

// Returns the direction across a normal that Cycles takes where it needs any.
template <class F> LANCER_LANE Vector3<F> across(const Vector3<F> &n) {
  const F one(1.0f);
  return select((n.x == n.y) & (n.x == n.z), cross(Vector3<F>(-one, one, one), n), cross(Vector3<F>(one), n));
}

template <class F> Value<F> normal_map_node(const Inputs<F> &in, const Site<F> &site) {
  using V3 = Vector3<F>;
  // The world has no tangents.
  if (!site.surface && in.node.option == 0)
    return solid(site.ns);
  const F zero(0.0f), one(1.0f);
  const V3 ns = in.normal(2, site);
  F strength = in.scalar(0);
  V3 color = F(2.0f) * (in[1] - V3(F(0.5f))), n;
  auto usable = uniform<F>(true);
  if (in.node.option == 0) {
    const V3 interpolated = object_normal(site);
    const V3 normal = in.node.flags & 1 ? unit_or_zero(interpolated) : interpolated;
    const Tangent<F> frame = tangent_at(in.node, site, normal);
    // Apply the strength before the transformation to the frame.
    color.x *= strength;
    color.y *= strength;
    color.z = one + (color.z - one) * clamp01(strength);
    const V3 bitangent = frame.sign * cross(normal, frame.t);
    n = normal_to_world(site, unit_or_zero(color.x * frame.t + color.y * bitangent + color.z * normal));
    n = select(site.backfacing, -n, n);
    usable = frame.found;
  } else {
    const bool inverted = in.node.option >= 3, object = in.node.option == 1 || in.node.option == 3;
    if (inverted)
      color = {color.x, -color.y, -color.z};
    n = object ? normal_to_world(site, color) : unit_or_zero(color);
    n = select(site.backfacing, -n, n);
    strength = max(strength, zero);
    n = select(strength != one, unit_or_zero(ns + (n - ns) * strength), n);
  }
  usable = usable & (!black(n)) & is_finite(n.x) & is_finite(n.y) & is_finite(n.z);
  return solid(select(usable, n, ns));
}

template <class F> Value<F> tangent_node(const Inputs<F> &in, const Site<F> &site) {
  using V3 = Vector3<F>;
  const Node &node = in.node;
  const V3 ns = in.normal(0, site);
  const F zero(0.0f);
  // The world has directions as generated coordinates, but no tangents along u; those of Geometry depend on the version.
  if (!site.surface && node.flags & 2)
    return solid(unit_or_zero(across(ns)));
  if (!site.surface && (node.option == 3 || node.flags & 1))
    return solid(V3(zero));
  V3 t;
  auto found = uniform<F>(true);
  if (node.option == 3) {
    const Tangent<F> frame = tangent_at(node, site, object_normal(site));
    t = frame.t;
    found = frame.found;
  } else {
    // Around the axis through the centre of the generated coordinates.
    const V3 g = generated(site, node.name) - V3(F(0.5f));
    t = node.option == 0 ? V3(zero, -g.z, g.y) : node.option == 1 ? V3(-g.z, zero, g.x) : V3(-g.y, g.x, zero);
  }
  t = normal_to_world(site, t);
  return solid(select(found, cross(ns, unit_or_zero(cross(t, ns))), V3(zero)));
}

template <class F> Value<F> displacement_node(const Inputs<F> &in, const Site<F> &site) {
  using D = DoubleOf<F>;
  const F offset = (in.scalar(0) - in.scalar(1)) * in.scalar(2);
  const Vector3<F> n = in.normal(3, site);
  if (!site.placed)
    return solid(n * offset);
  if (in.node.option == 0)
    return solid(normal_to_object(site, n) * offset);
  // The offset is a length in the user's world; convert it to object space.
  return solid(narrow(vector_to_object(site, widen(n) * (widen(offset) * D(site.user_scale())))));
}

// Returns the absolute cosine between the viewer and the normal of input 1.
template <class F> LANCER_LANE F cosine_to_viewer(const Inputs<F> &in, const Site<F> &site) {
  return abs(F(dot(site.wo, in.normal(1, site))));
}

template <class F> Value<F> fresnel_node(const Inputs<F> &in, const Site<F> &site) {
  const F ior = max(in.scalar(0), F(kSmallestIor));
  return scalar(fresnel_dielectric(cosine_to_viewer(in, site), select(site.backfacing, F(1.0f) / ior, ior)));
}

template <class F> Value<F> layer_weight_node(const Inputs<F> &in, const Site<F> &site) {
  const F one(1.0f), half(0.5f), two(2.0f), blend = in.scalar(0), cosine = cosine_to_viewer(in, site);
  if (in.node.option == 0) {
    const F inverse = max(one - blend, F(1e-5f));
    return scalar(fresnel_dielectric(cosine, select(site.backfacing, inverse, one / inverse)));
  }
  const F share = min(max(blend, F(0.0f)), F(1.0f - 1e-5f));
  const F exponent = select(share < half, two * share, half / (one - share));
  return scalar(select(blend == half, one - cosine, one - pow(cosine, exponent)));
}

} // namespace
} // namespace lancer
