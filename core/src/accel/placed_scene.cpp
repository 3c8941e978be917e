#include "accel/placed_scene.h"

#include "sampling/elementary.h"
#include "scene/ray.h"

#include <algorithm>
#include <cmath>

namespace lancer {
namespace {

bool finite(const glm::dvec3 &v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

PlacementFrame make_frame(const Extent &e) {
  PlacementFrame frame;
  const glm::dvec3 middle = e.middle(), half = e.half();
  const double largest = std::max({half.x, half.y, half.z});
  for (int i = 0; i < 3; ++i)
    frame.centre[i] = middle[i];
  int exponent = 0;
  if (std::frexp(largest, &exponent) > 0.0)
    frame.scale = std::ldexp(1.0, -std::clamp(exponent, -900, 900));
  return frame;
}

// Rounds to the nearest float; kBoxPad includes this error.
Box make_box(const PlacementFrame &frame, const Extent &e) {
  Box box;
  for (int i = 0; i < 3; ++i) {
    box.lo[i] = static_cast<float>((e.lo[i] - frame.centre[i]) * frame.scale - kBoxPad);
    box.hi[i] = static_cast<float>((e.hi[i] - frame.centre[i]) * frame.scale + kBoxPad);
  }
  box.lo[3] = box.hi[3] = 0.0f;
  return box;
}

glm::dmat3 magnitudes(const glm::dmat3 &m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

// Returns a bound of the displacement, in object space, that a round trip to the world gives a point with coordinates up to
// reach. Each map rounds to within gamma(4) of the sum of its terms' magnitudes, and the stored inverse is known to about
// gamma(20) of |to_object| |to_world|; 32 units of 2^-53 cover all of it.
glm::dvec3 round_trip(const Instance &instance, const glm::dvec3 &reach) {
  const glm::dvec3 world = magnitudes(instance.to_world.linear) * reach + glm::abs(instance.to_world.translation);
  return 0x1p-48 * (magnitudes(instance.to_object.linear) * world + glm::abs(instance.to_object.translation) + reach);
}

// Boxes in the world, padded by the displacement through rounding.
Extent shape_box(const Instance &instance) {
  const glm::dmat3 m = magnitudes(instance.to_world.linear);
  glm::dvec3 half = m * round_trip(instance, glm::dvec3(1.0));
  for (int i = 0; i < 3; ++i)
    half[i] += instance.kind == ShapeKind::Sphere ? glm::length(glm::dvec3(m[0][i], m[1][i], m[2][i]))
                                                  : hypot(m[0][i], m[1][i]) + m[2][i];
  const glm::dvec3 middle = instance.to_world.point(glm::dvec3(0.0));
  return {middle - half, middle + half};
}

Extent mesh_box(const Instance &instance, const std::vector<Extent> &parts, const glm::dvec3 &reach) {
  const glm::dmat3 m = magnitudes(instance.to_world.linear);
  Extent box;
  for (const Extent &part : parts) {
    const glm::dvec3 middle = instance.to_world.point(part.middle()), half = m * part.half();
    box.lo = glm::min(box.lo, middle - half);
    box.hi = glm::max(box.hi, middle + half);
  }
  // The box is not finite if the position of a part is not.
  const glm::dvec3 moved = m * round_trip(instance, reach);
  return {box.lo - moved, box.hi + moved};
}

// Sets the members that follow from the place.
void place_shape(const Instance &instance, PlacedShape &shape) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 3; ++column)
      shape.to_object[column][row] = row < 3 ? instance.to_object.linear[column][row] : 0.0;
    shape.to_object[3][row] = row < 3 ? instance.to_object.translation[row] : 0.0;
  }
  const glm::dvec3 moved = round_trip(instance, glm::dvec3(1.0));
  shape.slack = std::max({moved.x, moved.y, moved.z});
}

PlacedShape make_shape(const Instance &instance, const std::vector<PlacementFrame> &mesh_frames) {
  PlacedShape shape;
  place_shape(instance, shape);
  const bool mesh = instance.kind == ShapeKind::Mesh;
  shape.frame = mesh ? mesh_frames[instance.mesh] : PlacementFrame{};
  shape.kind = instance.kind;
  shape.mesh = mesh ? instance.mesh : kNone;
  shape.hidden_from = instance.hidden_from;
  shape.first_key = instance.first_key;
  shape.key_count = instance.key_count;
  return shape;
}

// Enlarges a box by the displacement through rounding, at any time.
void pad(const Instance &instance, const glm::dvec3 &reach, Extent &box) {
  const glm::dvec3 moved = magnitudes(instance.to_world.linear) * round_trip(instance, reach);
  box.lo -= moved;
  box.hi += moved;
}

// The boxes of an instance that moves, at equal steps of time. own: of its shape; reach: largest absolute coordinates.
std::vector<Extent> moving_extents(const GeometryView &geometry, const Instance &instance, std::span<const Extent> own,
                                   const glm::dvec3 &reach) {
  std::vector<Extent> extents = extents_over_time(geometry, instance, own);
  for (size_t i = 0; i < extents.size(); ++i) {
    Instance placed = instance;
    if (instance.key_count > 0)
      placed.place(placement_at(geometry.keys_of(instance), float(i) / float(extents.size() - 1)));
    pad(placed, reach, extents[i]);
  }
  return extents;
}

} // namespace

const PlacedShape &shape_at(const PlacedShape &shape, const PlacementKey *keys, float time, PlacedShape &moved) {
  if (shape.key_count == 0)
    return shape;
  Instance placed;
  placed.place(placement_at({keys + shape.first_key, shape.key_count}, time));
  moved = shape;
  place_shape(placed, moved);
  return moved;
}

MovingBox moving_box(const PlacementFrame &frame, std::span<const Extent> extents) {
  // Draw a line from the first to the last extent, and move it aside until it holds all others.
  Extent ends[2] = {extents.front(), extents.back()};
  glm::dvec3 below(0.0), above(0.0);
  for (size_t i = 0; i < extents.size(); ++i) {
    const double share = double(i) / double(extents.size() - 1);
    below = glm::max(below, glm::mix(ends[0].lo, ends[1].lo, share) - extents[i].lo);
    above = glm::max(above, extents[i].hi - glm::mix(ends[0].hi, ends[1].hi, share));
  }
  MovingBox box;
  for (int end = 0; end < 2; ++end) {
    box.at[end] = make_box(frame, {ends[end].lo - below, ends[end].hi + above});
    // Rounding in lo + time * (hi - lo): of the difference, the product and the sum, on numbers of at most 2, 2 and 1.
    const Float4 rounding{kMovingPad, kMovingPad, kMovingPad, 0.0f};
    box.at[end].lo -= rounding;
    box.at[end].hi += rounding;
  }
  return box;
}

PlacementFrame mesh_frame(const Extent &faces) { return faces.empty() ? PlacementFrame{} : make_frame(faces); }

PlacedScene place_scene(const GeometryView &geometry, MeshOwners owners) {
  PlacedScene scene;
  std::vector<uint32_t> uses(geometry.meshes.size(), 0);
  for (const Instance &instance : geometry.instances)
    if (instance.kind == ShapeKind::Mesh)
      ++uses[instance.mesh];
  std::vector<std::vector<Extent>> mesh_parts;    // a single box for meshes with one instance
  std::vector<std::span<const Extent>> mesh_keys; // the boxes at keys, or one
  std::vector<std::shared_ptr<const MeshBounds>> bounds;
  for (size_t i = 0; i < geometry.meshes.size(); ++i) {
    const MeshView &mesh = geometry.meshes[i];
    bounds.push_back(bounds_of(mesh, owner_of(owners, i)));
    const Extent &whole = bounds.back()->faces;
    mesh_keys.push_back(bounds.back()->keys.empty() ? std::span(&whole, 1) : std::span(bounds.back()->keys));
    mesh_parts.push_back(uses[i] > 1 ? cells_of(mesh, whole, owner_of(owners, i))->boxes : std::vector{whole});
    scene.mesh_frames.push_back(mesh_frame(whole));
    scene.mesh_reach.push_back(glm::max(glm::abs(whole.lo), glm::abs(whole.hi)));
  }

  // Place every instance; find the world box of each bounded one.
  std::vector<Extent> extents;
  std::vector<std::vector<Extent>> moving; // by number in extents; empty: it stands still
  const Extent unit{glm::dvec3(-1.0), glm::dvec3(1.0)};
  bool any_moves = false;
  Extent all;
  scene.shapes.reserve(geometry.instances.size());
  scene.bounded.reserve(geometry.instances.size());
  extents.reserve(geometry.instances.size());
  for (uint32_t i = 0; i < geometry.instances.size(); ++i) {
    const Instance &instance = geometry.instances[i];
    scene.shapes.push_back(make_shape(instance, scene.mesh_frames));
    const bool mesh = instance.kind == ShapeKind::Mesh;
    if (mesh && geometry.meshes[instance.mesh].triangles.empty())
      continue;
    Extent world;
    std::vector<Extent> over_time;
    if (!geometry.moves(instance)) {
      world = mesh ? mesh_box(instance, mesh_parts[instance.mesh], scene.mesh_reach[instance.mesh]) : shape_box(instance);
    } else {
      over_time = moving_extents(geometry, instance, mesh ? mesh_keys[instance.mesh] : std::span(&unit, 1),
                                 mesh ? scene.mesh_reach[instance.mesh] : glm::dvec3(1.0));
      for (const Extent &extent : over_time) {
        world.grow(extent.lo);
        world.grow(extent.hi);
      }
    }
    if (instance.kind == ShapeKind::Plane || !finite(world.hi - world.lo)) {
      scene.unbounded.push_back(i);
      continue;
    }
    scene.bounded.push_back(i);
    extents.push_back(world);
    any_moves |= !over_time.empty();
    moving.push_back(std::move(over_time));
    all.grow(world.lo);
    all.grow(world.hi);
  }

  if (!extents.empty())
    scene.world = make_frame(all);
  scene.boxes.reserve(extents.size());
  for (const Extent &extent : extents)
    scene.boxes.push_back(make_box(scene.world, extent));
  for (size_t i = 0; i < extents.size() && any_moves; ++i) {
    scene.moving.push_back({{scene.boxes[i], scene.boxes[i]}});
    if (moving[i].empty())
      continue;
    scene.moving[i] = moving_box(scene.world, moving[i]);
    scene.boxes[i] = scene.moving[i].swept();
  }
  return scene;
}

PlacedTriangleBoxes::PlacedTriangleBoxes(const MeshView &m, const Instance &instance, const glm::dvec3 &reach,
                                         const PlacementFrame &w)
    : mesh(m), to_world(instance.to_world), moved(magnitudes(instance.to_world.linear) * round_trip(instance, reach)),
      world(w) {}

Box PlacedTriangleBoxes::operator()(uint32_t triangle) const {
  Extent e;
  for (int corner = 0; corner < 3; ++corner)
    e.grow(to_world.point(glm::dvec3(mesh.vertex(triangle, corner))));
  e.lo -= moved;
  e.hi += moved;
  return make_box(world, e);
}

Box triangle_box(const MeshView &mesh, const PlacementFrame &frame, uint32_t triangle) {
  Extent e;
  for (int corner = 0; corner < 3; ++corner)
    e.grow(glm::dvec3(mesh.vertex(triangle, corner)));
  return make_box(frame, e);
}

MovingBox moving_triangle_box(const MeshView &mesh, const PlacementFrame &frame, uint32_t triangle) {
  Extent extents[kMostKeys];
  for (uint32_t key = 0; key < mesh.key_count; ++key) {
    Extent &extent = extents[key];
    double reach = 0.0;
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p(mesh.key_vertex(triangle, corner, key));
      extent.grow(p);
      reach = std::max(reach, largest_coordinate(p));
    }
    extent.lo -= kKeyRounding * reach;
    extent.hi += kKeyRounding * reach;
  }
  return moving_box(frame, {extents, mesh.key_count});
}

size_t PlacedScene::bytes() const {
  return shapes.capacity() * sizeof(PlacedShape) + mesh_frames.capacity() * sizeof(PlacementFrame) +
         boxes.capacity() * sizeof(Box) + moving.capacity() * sizeof(MovingBox) +
         (unbounded.capacity() + bounded.capacity()) * sizeof(uint32_t);
}

} // namespace lancer
