#include "accel/coplanar/flat_face.h"

#include "accel/bounds.h"
#include "simd/parallel.h"

#include <cstring>
#include <map>

namespace lancer {

namespace {

// The number of compared faces: kCompared, plus one of each kOfMeshes faces of the meshes, plus kOfEach of each instance that
// touches others, at most kMost.
constexpr size_t kCompared = 4096, kOfMeshes = 256, kOfEach = 16, kMost = 16384;
// Largest number of compared pairs of boxes per instance. It bounds the effort for many instances at one place.
constexpr size_t kPairs = 128;
// Quantisation steps of planes over the scene's extent.
constexpr double kOffsetCells = 256.0;

class Chooser {
public:
  Chooser(const GeometryView &g, const FaceRounding &r, const BuildContext &c) : geometry(g), rounding(r), context(c) {}

  FaceCandidates choose_all() {
    choose();
    return std::move(found);
  }

private:
  // Returns the instances whose boxes overlap others.
  std::vector<uint8_t> find_neighbours(const std::vector<glm::dvec3> &low, const std::vector<glm::dvec3> &high) const {
    std::vector<uint8_t> met(low.size(), 0);
    std::vector<uint32_t> order(low.size());
    for (uint32_t i = 0; i < order.size(); ++i)
      order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return low[a].x != low[b].x ? low[a].x < low[b].x : a < b; });
    size_t left = kPairs * order.size();
    for (size_t i = 0; i < order.size(); ++i)
      for (size_t k = i + 1; k < order.size() && low[order[k]].x <= high[order[i]].x; ++k) {
        if (left-- == 0)
          return std::vector<uint8_t>(low.size(), 1);
        if (boxes_meet(low[order[i]], high[order[i]], low[order[k]], high[order[k]]))
          met[order[i]] = met[order[k]] = 1;
      }
    return met;
  }

  // Chooses some of a mesh's triangles evenly, and all that are large in comparison with the mesh.
  std::vector<uint32_t> choose_triangles(const MeshView &mesh, double extent, size_t most) const {
    const uint32_t count = static_cast<uint32_t>(mesh.triangles.size());
    std::vector<uint32_t> chosen;
    if (count <= most) {
      for (uint32_t i = 0; i < count; ++i)
        chosen.push_back(i);
      return chosen;
    }
    // Four times the size of the triangles if they were equal and covered a cube.
    const float large = static_cast<float>(4.0 * extent * std::sqrt(12.0 / count));
    const uint32_t stride = static_cast<uint32_t>(2 * count / most + 1);
    // Loads four floats; the last vertex has no float behind it.
    const uint32_t last = static_cast<uint32_t>(mesh.positions.size()) - 1;
    const auto corner = [&](uint32_t vertex) {
      const glm::vec3 &p = mesh.positions[vertex];
      Float4 four;
      if (vertex == last)
        return Float4{p.x, p.y, p.z, 0.0f};
      std::memcpy(&four, &p, sizeof four);
      return four;
    };
    for (uint32_t i = 0, next = 0; i < count; ++i) {
      const glm::uvec3 &triangle = mesh.triangles[i];
      const Float4 a = corner(triangle.x), b = corner(triangle.y), c = corner(triangle.z);
      const Float4 size = max4(a, max4(b, c)) - min4(a, min4(b, c));
      const bool is_large = (size[0] > large) | (size[1] > large) | (size[2] > large);
      if (i != next && !is_large)
        continue;
      if (i == next)
        next += stride;
      else if (chosen.size() >= most)
        continue;
      chosen.push_back(i);
    }
    return chosen;
  }

  void add(uint32_t instance, uint32_t primitive, const glm::dvec3 corner[3]) {
    if (const auto candidate = face_candidate(rounding, instance, primitive, corner))
      found.faces.push_back(*candidate);
  }

  // Adds the square around a flat part of an exact surface, in its own space at a height.
  void add_square(uint32_t instance, double height, double half) {
    const Affine &place = geometry.instances[instance].to_world;
    glm::dvec3 p[4];
    for (int i = 0; i < 4; ++i)
      p[i] = place.point({i == 0 || i == 3 ? -half : half, i < 2 ? -half : half, height});
    const glm::dvec3 one[3] = {p[0], p[1], p[2]}, other[3] = {p[0], p[2], p[3]};
    add(instance, 0, one);
    add(instance, 0, other);
  }

  void choose() {
    const size_t count = geometry.instances.size();
    std::vector<glm::dvec3> low(count), high(count);
    glm::dvec3 all_low(std::numeric_limits<double>::infinity()), all_high = -all_low;
    for (uint32_t i = 0; i < count; ++i) {
      rounding.box(i, low[i], high[i]);
      if (geometry.instances[i].kind == ShapeKind::Plane)
        continue;
      all_low = glm::min(all_low, low[i]);
      all_high = glm::max(all_high, high[i]);
    }
    const glm::dvec3 size = all_high - all_low;
    if (size.x >= 0.0)
      found.step = std::max({size.x, size.y, size.z}) / kOffsetCells;
    const std::vector<uint8_t> met = find_neighbours(low, high);
    size_t faces = 0;
    for (const MeshView &mesh : geometry.meshes)
      faces += mesh.triangles.size();
    const size_t touching = std::max<size_t>(1, static_cast<size_t>(std::count(met.begin(), met.end(), 1)));
    const size_t budget = std::min(kCompared + faces / kOfMeshes + kOfEach * touching, kMost),
                 share = std::max(kOfEach, budget / touching);
    std::map<uint32_t, std::vector<uint32_t>> chosen;
    // Begin with instances that touch others.
    for (const bool neighbours : {true, false})
      for (uint32_t i = 0; i < count && found.faces.size() < budget; ++i) {
        const Instance &instance = geometry.instances[i];
        // The planes of a shape that moves have no order: they coincide with others at single times.
        if (met[i] != neighbours || instance.kind == ShapeKind::Sphere || geometry.moves(instance))
          continue;
        poll_cancel(context);
        if (instance.kind == ShapeKind::Cylinder || instance.kind == ShapeKind::Cone) {
          add_square(i, -1.0, 1.0);
          if (instance.kind == ShapeKind::Cylinder)
            add_square(i, 1.0, 1.0);
          continue;
        }
        if (instance.kind == ShapeKind::Plane) {
          add_plane(i, all_low, all_high);
          continue;
        }
        const MeshView &mesh = geometry.meshes[instance.mesh];
        if (!neighbours && mesh.triangles.size() > kCompared)
          continue;
        auto [at, fresh] = chosen.try_emplace(instance.mesh);
        if (fresh)
          at->second = choose_triangles(mesh, rounding.extent_of_mesh(instance.mesh), neighbours ? share : kCompared);
        for (const uint32_t triangle : at->second) {
          glm::dvec3 corner[3];
          world_corners(geometry, i, triangle, corner);
          add(i, triangle, corner);
        }
      }
  }

  void add_plane(uint32_t i, const glm::dvec3 &low, const glm::dvec3 &high) {
    // Make the square as large as the scene.
    const Instance &instance = geometry.instances[i];
    if (!(low.x <= high.x))
      return add_square(i, 0.0, 1.0);
    glm::dvec3 half(0.0);
    for (int corner = 0; corner < 8; ++corner)
      half = glm::max(half, glm::abs(instance.to_object.point(
                                {corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z})));
    add_square(i, 0.0, 2.0 * std::max(half.x, half.y));
  }

  const GeometryView geometry;
  const FaceRounding &rounding;
  const BuildContext &context;
  FaceCandidates found;
};

} // namespace

size_t faces_of(const GeometryView &geometry, uint32_t instance) {
  const Instance &placed = geometry.instances[instance];
  if (geometry.moves(placed))
    return 0;
  if (placed.kind == ShapeKind::Mesh)
    return geometry.meshes[placed.mesh].triangles.size();
  return placed.kind == ShapeKind::Sphere ? 0 : 1;
}

std::optional<FaceCandidate> face_candidate(const FaceRounding &rounding, uint32_t instance, uint32_t primitive,
                                            const glm::dvec3 corner[3]) {
  FaceCandidate c;
  std::copy(corner, corner + 3, c.corner);
  c.face = triangle_face(corner);
  if (!(c.face.height > 0.0))
    return {};
  c.rounding = rounding.share(instance, corner[0]);
  c.low = glm::min(corner[0], glm::min(corner[1], corner[2])) - c.rounding;
  c.high = glm::max(corner[0], glm::max(corner[1], corner[2])) + c.rounding;
  c.instance = instance;
  c.primitive = primitive;
  return c;
}

FaceCandidates choose_faces(const GeometryView &geometry, const FaceRounding &rounding, const BuildContext &context) {
  return Chooser(geometry, rounding, context).choose_all();
}

} // namespace lancer
