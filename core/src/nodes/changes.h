// The changes of nodes' values over a pixel, for images with mipmaps. As in Cycles, coordinates, attributes and the arithmetic
// of vectors have changes; the values of all other nodes are taken as constant. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/color_nodes.h"
#include "nodes/coordinate_nodes.h"
#include "nodes/dual.h"
#include "nodes/moved_site.h"
#include "nodes/normal_nodes.h"

namespace lancer {
namespace {

// The changes of a node's value along two directions of the picture.
template <class F> struct Change { Vector3<F> x, y; };
template <class F> LANCER_LANE Change<F> no_change() { return {Vector3<F>(F(0.0f)), Vector3<F>(F(0.0f))}; }
template <class F> LANCER_LANE Change<F> change_of(const Vector3<Dual<F>> &v) {
  return {{v.x.dx, v.y.dx, v.z.dx}, {v.x.dy, v.y.dy, v.z.dy}};
}

// The inputs of a node with their changes.
template <class F> struct ChangingInputs {
  using Number = Dual<F>;
  const ProgramView &program;
  const Inputs<F> &in;
  const Node &node;

  LANCER_LANE Vector3<Dual<F>> operator[](int i) const {
    const Vector3<F> v = in[i];
    const int32_t slot = slot_of(i);
    if (slot < 0)
      return {Dual<F>(v.x), Dual<F>(v.y), Dual<F>(v.z)};
    const Vector3<F> x = in.values.get(slot), y = in.values.get(slot + 1);
    return {{v.x, x.x, y.x}, {v.y, x.y, y.y}, {v.z, x.z, y.z}};
  }
  LANCER_LANE Dual<F> scalar(int i) const { return (*this)[i].x; }
  // Returns the slot of an input's changes; -1 if it is taken as constant, as all but the vector of a Mapping are.
  LANCER_LANE int32_t slot_of(int i) const {
    const Parameter &input = node.inputs[i];
    return input.varies() && (i == 0 || node.kind != NodeKind::Mapping) ? program.nodes[size_t(input.node)].changes : -1;
  }
};

// Returns the steps of a pixel along a surface, or those of a direction of the world: as in Cycles, a circle in the tangent
// plane, whatever the angle of the view; for displacement, the edges of the triangle.
template <class F> struct PixelSteps { Vector3<DoubleOf<F>> x, y; };
template <class F> PixelSteps<F> pixel_steps(const Site<F> &site, const Plane<F> &plane) {
  if (site.displaces)
    return {plane.e1, plane.e2};
  const Vector3<F> x = normalize(across(site.ng)), y = cross(site.ng, x);
  return {widen(site.path.width * x), widen(site.path.width * y)};
}

template <class F> Vector3<F> changing_value(const Node &node, const Site<F> &site) {
  return node.kind == NodeKind::Attribute ? attribute_node(node, site).v : coordinate_node(node, site).v;
}

// Returns the change of a coordinate or an attribute.
template <class F> Change<F> place_change(const Node &node, const Site<F> &site) {
  const F zero(0.0f);
  if (node.kind == NodeKind::Coordinate)
    switch (node.option) {
    case Coordinate::Incoming:
    case Coordinate::Reflection: {
      const Vector3<F> x = normalize(across(site.wo)), y = cross(site.wo, x);
      const bool mirrored = node.option == Coordinate::Reflection && site.surface;
      const auto turned = [&](const Vector3<F> &d) { return mirrored ? F(F(2.0f) * dot(site.ns, d)) * site.ns - d : d; };
      return {turned(site.path.spread * x), turned(site.path.spread * y)};
    }
    case Coordinate::Window: {
      const Camera *camera = site.scene.camera;
      if (!camera)
        return no_change<F>();
      return {{F(1.0f / static_cast<float>(camera->width)), zero, zero},
              {zero, F(1.0f / static_cast<float>(camera->height)), zero}};
    }
    case Coordinate::Generated:
    case Coordinate::Normal:
    case Coordinate::Uv:
    case Coordinate::Object:
    case Coordinate::Camera:
    case Coordinate::Position:
    case Coordinate::Parametric:
      break;
    default:
      return no_change<F>();
    }
  Site<F> here = site;
  // The normal of a place is the interpolated one.
  here.in_height = here.in_height || (node.kind == NodeKind::Coordinate && node.option == Coordinate::Normal);
  Plane<F> plane;
  if (any(site.on_mesh))
    plane = plane_of(site);
  else if (site.displaces)
    return no_change<F>();
  const PixelSteps<F> steps = pixel_steps(site, plane);
  const auto change = [&](const Vector3<DoubleOf<F>> &step) {
    Site<F> there = here;
    move(plane, step, there);
    return changing_value(node, there) - changing_value(node, here);
  };
  return {change(steps.x), change(steps.y)};
}

// Returns the change of a value that this file's first comment lists.
template <class F> Change<F> node_change(const ProgramView &program, const Inputs<F> &in, const Site<F> &site) {
  const Node &node = in.node;
  const ChangingInputs<F> changing{program, in, node};
  switch (node.kind) {
  case NodeKind::Coordinate:
  case NodeKind::Attribute:
    return place_change(node, site);
  case NodeKind::Mapping:
    return change_of(mapping_node(changing).v);
  case NodeKind::VectorMath:
    return change_of(vector_math_node(changing).v);
  case NodeKind::Separate:
    return change_of(separate_node(changing).v);
  case NodeKind::Combine:
    return change_of(combine_node(changing).v);
  case NodeKind::Grey:
    return change_of(grey_node(changing).v);
  case NodeKind::Transform: {
    const int32_t slot = changing.slot_of(0);
    if (slot < 0 || node.option == 2)
      return no_change<F>();
    const auto moved = [&](const Vector3<F> &d) { return narrow(rows_times(node.matrix, widen(d), 0.0)); };
    return {moved(in.values.get(slot)), moved(in.values.get(slot + 1))};
  }
  default:
    return no_change<F>();
  }
}

} // namespace
} // namespace lancer
