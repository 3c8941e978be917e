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

PlacedShape make_shape(const Instance &instance, const std::vector<PlacementFrame> &mesh_frames) {
  PlacedShape shape;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 3; ++column)
      shape.to_object[column][row] = row < 3 ? instance.to_object.linear[column][row] : 0.0;
    shape.to_object[3][row] = row < 3 ? instance.to_object.translation[row] : 0.0;
  }
  const bool mesh = instance.kind == ShapeKind::Mesh;
  const glm::dvec3 moved = round_trip(instance, glm::dvec3(1.0));
  shape.frame = mesh ? mesh_frames[instance.mesh] : PlacementFrame{};
  shape.slack = std::max({moved.x, moved.y, moved.z});
  shape.kind = instance.kind;
  shape.mesh = mesh ? instance.mesh : kNone;
  shape.hidden_from = instance.hidden_from;
  return shape;
}

} // namespace

PlacementFrame mesh_frame(const Extent &faces) { return faces.empty() ? PlacementFrame{} : make_frame(faces); }

PlacedScene place_scene(const GeometryView &geometry, MeshOwners owners) {
  PlacedScene scene;
  std::vector<uint32_t> uses(geometry.meshes.size(), 0);
  for (const Instance &instance : geometry.instances)
    if (instance.kind == ShapeKind::Mesh)
      ++uses[instance.mesh];
  std::vector<std::vector<Extent>> mesh_parts; // a single box for meshes with one instance
  for (size_t i = 0; i < geometry.meshes.size(); ++i) {
    const MeshView &mesh = geometry.meshes[i];
    const Extent whole = bounds_of(mesh, owner_of(owners, i))->faces;
    mesh_parts.push_back(uses[i] > 1 ? cells_of(mesh, whole, owner_of(owners, i))->boxes : std::vector{whole});
    scene.mesh_frames.push_back(mesh_frame(whole));
    scene.mesh_reach.push_back(glm::max(glm::abs(whole.lo), glm::abs(whole.hi)));
  }

  // Place every instance; find the world box of each bounded one.
  std::vector<Extent> extents;
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
    const Extent world =
        mesh ? mesh_box(instance, mesh_parts[instance.mesh], scene.mesh_reach[instance.mesh]) : shape_box(instance);
    if (instance.kind == ShapeKind::Plane || !finite(world.hi - world.lo)) {
      scene.unbounded.push_back(i);
      continue;
    }
    scene.bounded.push_back(i);
    extents.push_back(world);
    all.grow(world.lo);
    all.grow(world.hi);
  }

  if (!extents.empty())
    scene.world = make_frame(all);
  scene.boxes.reserve(extents.size());
  for (const Extent &extent : extents)
    scene.boxes.push_back(make_box(scene.world, extent));
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

size_t PlacedScene::bytes() const {
  return shapes.capacity() * sizeof(PlacedShape) + mesh_frames.capacity() * sizeof(PlacementFrame) +
         boxes.capacity() * sizeof(Box) + (unbounded.capacity() + bounded.capacity()) * sizeof(uint32_t);
}

} // namespace lancer
