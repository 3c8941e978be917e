// Bumps: the height's slope over a pixel's footprint tilts the normal. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/moved_site.h"
#include "nodes/normal_nodes.h"

#include <cstddef>

namespace lancer {

// Memory for values of nodes that do not fit on the stack.
// Aligned for lanes. Throws std::bad_alloc.
void *allocate_values(size_t bytes);
void free_values(void *values);

namespace {

// Computes the scheduled nodes at a site; defined in dispatch.h.
template <class F>
void run_nodes(const ProgramView &program, ScheduleView schedule, const Site<F> &site, const Values<F> &values);

// Two directions along the surface, and the surface's displacement along them by one pixel's footprint, in the user's units.
template <class F> struct Steps {
  using D = DoubleOf<F>;
  Vector3<D> x, y; // unit, in the normalised world
  Vector3<D> px, py;
  Plane<F> plane;                // in lanes on meshes
  AttributeLanes<F> undisplaced; // where found, px, py and the normal are in object space
};

// An attribute at a triangle's three corners.
template <class F> struct Triangle { Vector3<F> v0, v1, v2; };
template <class F> Triangle<F> triangle_of(const Site<F> &site, const AttributeLanes<F> &attribute) {
  const CornerValues<F> of = corner_values(site, attribute);
  const F zero(0.0f), one(1.0f);
  return {between(of, {one, zero, zero}).v, between(of, {zero, one, zero}).v, between(of, {zero, zero, one}).v};
}

template <class F> Steps<F> steps_at(const Node &node, const Site<F> &site) {
  using D = DoubleOf<F>;
  Steps<F> r;
  const Vector3<F> &ng = site.ng;
  r.x = normalize(widen(across(ng)));
  r.y = cross(widen(ng), r.x);
  const D footprint = widen(site.footprint), size = footprint / D(site.user_scale());
  r.px = r.x * size;
  r.py = r.y * size;
  if (any(site.on_mesh))
    r.plane = plane_of(site);
  if (!(node.flags & 2)) {
    r.undisplaced.found = uniform<F>(false);
    return r;
  }
  // Without displacement, both surfaces are the same; compute the steps in object space.
  const Vector3<D> x = r.x * footprint, y = r.y * footprint;
  r.px = vector_to_object(site, x);
  r.py = vector_to_object(site, y);
  r.undisplaced = find_attributes(site, node.name);
  if (!any(r.undisplaced.found))
    return r;
  // The same steps in weights of the vertices, taken on the undisplaced surface.
  const Triangle<F> was = triangle_of(site, r.undisplaced);
  const Vector3<D> e1 = widen(was.v1) - widen(was.v0), e2 = widen(was.v2) - widen(was.v0);
  const auto moved_by = [&](const Vector3<D> &offset) {
    Site<F> there = site;
    move(r.plane, offset, there);
    return D(there.bary[0] - site.bary[0]) * e1 + D(there.bary[1] - site.bary[1]) * e2;
  };
  r.px = select(r.undisplaced.found, moved_by(x), r.px);
  r.py = select(r.undisplaced.found, moved_by(y), r.py);
  return r;
}

// Returns the site of a height evaluation: moved, and on the undisplaced surface if the node requests it.
template <class F> Site<F> height_site(const Site<F> &site, const Steps<F> &steps, const Vector3<DoubleOf<F>> &offset) {
  Site<F> place = site;
  move(steps.plane, offset, place);
  place.in_height = true;
  place.still = &site;
  if (any(steps.undisplaced.found)) {
    const auto was = widen(attribute_at(place, steps.undisplaced).v);
    const auto p = vector_to_world(site, was) + translation_of(site, &Instance::to_world);
    place.p = select(steps.undisplaced.found, p, place.p);
  }
  return place;
}

// Returns the normal input; on a displaced flat face, the face's normal before displacement.
template <class F> Vector3<F> flat_normal_before(const Inputs<F> &in, const Site<F> &site) {
  const Vector3<F> normal = in.normal(3, site);
  if (!any(site.on_mesh))
    return normal;
  const AttributeLanes<F> before = find_attributes(site, kUndisplaced);
  const auto flat = before.found & same(normal, site.ng);
  if (!any(flat))
    return normal;
  const Triangle<F> was = triangle_of(site, before);
  const Vector3<F> n = normal_to_world(site, cross(was.v1 - was.v0, was.v2 - was.v0));
  return select(flat, select(dot(n, site.ng) < F(0.0f), -n, n), normal);
}

// Saves values of nodes before the height's nodes overwrite them. Code between save() and bring_back() must not throw: a
// destructor would need exception tables, which are shared symbols and must not occur in kernels.
template <class F> class Kept {
public:
  void save(ScheduleView schedule, const Values<F> &values) {
    if (schedule.size() > kFew)
      kept_ = static_cast<Value<F> *>(allocate_values(schedule.size() * sizeof(Value<F>)));
    for (size_t i = 0; i < schedule.size(); ++i)
      kept_[i] = {values.get(schedule[i]), values.get(schedule[i], 3)};
  }
  void bring_back(ScheduleView schedule, const Values<F> &values) {
    for (size_t i = 0; i < schedule.size(); ++i)
      values.set(schedule[i], kept_[i]);
    if (kept_ != few_)
      free_values(kept_);
  }

private:
  static constexpr size_t kFew = 32;
  Value<F> few_[kFew];
  Value<F> *kept_ = few_;
};

// Runs the height's nodes at three points and restores the values.
template <class F> Value<F> bump_node(const ProgramView &program, const Inputs<F> &in, const Site<F> &site) {
  using D = DoubleOf<F>;
  using D3 = Vector3<D>;
  const F zero(0.0f), one(1.0f);
  const Vector3<F> normal = in.node.flags & 4 ? flat_normal_before(in, site) : in.normal(3, site);
  // Within the height of a bump, ignore other bumps: each level would triple the evaluations.
  if (site.in_height || !site.surface)
    return solid(normal);
  const F filter = in.scalar(4);
  const auto seen = (site.footprint > zero) & (filter > zero);
  if (!any(seen))
    return solid(normal);
  const bool in_object = in.node.flags & 2;
  const Steps<F> steps = steps_at(in.node, site);

  // Compute the height here and at both offsets, and restore the values.
  const ScheduleView schedule = program.heights_of(in.node);
  Kept<F> kept;
  kept.save(schedule, in.values);
  const auto height = [&](const D3 &offset) {
    run_nodes(program, schedule, height_site(site, steps, offset), in.values);
    return D(widen(in.scalar(2)));
  };
  const D step = widen(site.footprint) * widen(filter);
  const D here = height(D3(D(0.0))), dx = height(step * steps.x) - here, dy = height(step * steps.y) - here;
  kept.bring_back(schedule, in.values);

  // Tilt the normal against the slope.
  const Vector3<F> straight = in_object ? normal_to_object(site, normal) : normal;
  const D3 n = widen(straight), rx = cross(steps.py, n), ry = cross(n, steps.px);
  const D det = dot(steps.px, rx), distance = widen(in.scalar(1)) * D(in.node.flags & 1 ? -1.0 : 1.0);
  const D3 slope = (dx * rx + dy * ry) * select(det < D(0.0), -distance, distance);
  const D3 sum = D(widen(filter) * abs(det)) * n - slope;
  const D size = length(sum);
  const auto usable = seen & (size > D(0.0)) & (size <= D(1.7976931348623157e308));
  const F strength = max(in.scalar(0), zero);
  const Vector3<F> tilted = unit_or_zero(strength * narrow(sum / size) + F(one - strength) * straight);
  return solid(select(usable, in_object ? normal_to_world(site, tilted) : tilted, normal));
}

} // namespace

} // namespace lancer
