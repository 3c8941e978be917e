// The priority order among coplanar faces, which decides the face that a ray hits. Faces that other faces of their plane
// overlap are found once. Each of them has a grid of the places that other faces cover. An accelerator applies the order to the
// hits of any other accelerator.
#pragma once

#include "accel/accelerator.h"
#include "accel/coplanar/flat_face.h"

#include <bit>
#include <span>
#include <tuple>
#include <vector>

namespace lancer {

// Input of the priority order besides the geometry.
struct PlaneRules {
  glm::dvec3 origin{0.0};                   // of the user's world, in which instances are placed in float
  std::vector<uint8_t> see_through_slots{}; // by slot: light passes its material, straight or refracted; empty: none
  std::vector<uint8_t> emitting_slots{};    // by slot: its material emits; empty: none does

  bool operator==(const PlaneRules &) const = default;
};

// The priority of a face: of the coplanar faces at a place, a ray hits the face with the smallest order.
using PlaneOrder = std::tuple<bool, bool, uint32_t, uint32_t, uint32_t>;
PlaneOrder plane_order(const GeometryView &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive);
bool face_emits(const GeometryView &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive);

// A triangle in the coordinates of the face that it covers. A place is inside if slope * at + offset >= 0 for all three sides.
struct CoverPatch {
  glm::dvec2 slope[3];
  double offset[3];
  glm::dvec2 low, high; // bounding box of its part on the face
  bool loses = false;   // the covered face has lower priority

  bool has(const glm::dvec2 &at) const {
    return glm::dot(slope[0], at) + offset[0] >= 0.0 && glm::dot(slope[1], at) + offset[1] >= 0.0 &&
           glm::dot(slope[2], at) + offset[2] >= 0.0;
  }
  // Returns false if a box lies entirely outside one side.
  bool meets(const glm::dvec2 &middle, const glm::dvec2 &half) const {
    for (int i = 0; i < 3; ++i)
      if (glm::dot(slope[i], middle) + glm::dot(glm::abs(slope[i]), half) + offset[i] < 0.0)
        return false;
    return true;
  }
};

// Makes the patch of the triangle `other` on `face`. border: width by which it may be hit beyond its sides.
CoverPatch make_patch(const FaceCoordinates &coordinates, const glm::dvec3 face[3], const glm::dvec3 other[3], double border);

// The patches of faces, numbered in order of adding, with a grid for each face.
class Cover {
public:
  void add_face(std::span<const CoverPatch> patches, const FaceCoordinates &coordinates);
  void add_face_covered_anywhere() { faces_.emplace_back(); }

  bool empty() const { return faces_.empty(); }
  // Returns whether a place of a face may have a patch; may_lose(): a patch of higher priority than the face.
  bool may_be_covered(size_t face, const glm::dvec3 &p) const {
    return faces_[face].side == 0 || may_be(faces_[face], faces_[face].coordinates(p), false);
  }
  bool may_lose(size_t face, const glm::dvec3 &p) const {
    return faces_[face].side == 0 || may_be(faces_[face], faces_[face].coordinates(p), true);
  }
  bool may_lose(size_t face, const glm::dvec2 &at) const { return faces_[face].side == 0 || may_be(faces_[face], at, true); }
  size_t bytes() const;

private:
  struct Face {
    FaceCoordinates coordinates{};
    glm::dvec2 low{0.0}, cells_per_unit{0.0};
    uint32_t first_cell = 0;
    int side = 0; // cells along each axis; 0: covered anywhere

    // Outside the grid: -1 or side.
    glm::ivec2 cell(const glm::dvec2 &at) const;
  };

  bool may_be(const Face &face, const glm::dvec2 &at, bool to_lose) const;

  std::vector<Face> faces_;
  std::vector<uint32_t> begins_; // by cell: its first entry; the next cell's begin ends it
  std::vector<uint32_t> entries_;
  std::vector<CoverPatch> patches_;
};

// Faces that coplanar faces may cover. A few of them may be uncovered.
struct CoplanarFaces {
  std::vector<uint8_t> instances; // 1: the instance has such faces; empty if no instance has
  std::vector<uint32_t> first;    // by instance: its first word of bits
  std::vector<uint64_t> bits;     // by face
  std::vector<uint32_t> ranks;    // by word of bits: number of faces marked before it
  Cover cover;                    // by rank; empty if each face may be covered anywhere

  bool any() const { return !instances.empty(); }
  bool has(uint32_t instance, uint32_t primitive) const {
    return instances[instance] && bits[first[instance] + (primitive >> 6)] >> (primitive & 63) & 1;
  }
  // Returns whether other faces may be at a place of such a face.
  bool may_be_covered(uint32_t instance, uint32_t primitive, const glm::dvec3 &p) const {
    return cover.empty() || cover.may_be_covered(rank(instance, primitive), p);
  }
  // Returns whether such a face may have higher priority. at: p, or the weights of a triangle's corners in a hit.
  template <class Place> bool may_lose(uint32_t instance, uint32_t primitive, const Place &at) const {
    return cover.empty() || cover.may_lose(rank(instance, primitive), at);
  }
  size_t bytes() const {
    return instances.capacity() + (first.capacity() + ranks.capacity()) * sizeof(uint32_t) +
           bits.capacity() * sizeof(uint64_t) + cover.bytes();
  }

private:
  size_t rank(uint32_t instance, uint32_t primitive) const {
    const size_t word = first[instance] + (primitive >> 6);
    const uint64_t before = (uint64_t{1} << (primitive & 63)) - 1;
    return ranks[word] + static_cast<size_t>(std::popcount(bits[word] & before));
  }
};

// Returns the same faces for every accelerator; its cost is bounded.
CoplanarFaces find_coplanar_faces(const GeometryView &geometry, const FaceRounding &rounding, const PlaneRules &rules,
                                  const BuildContext &context);

// Returns an accelerator that applies the priority order to the hits of another; in a scene without such faces, the other. If
// several faces cover one place of a plane within rounding, a ray from either side hits the first in this order: opaque before
// others, emitting before others, then smaller instance, smaller slot, smaller number. A ray that starts on a face hits no
// other face of its plane.
std::shared_ptr<const Accelerator> order_coplanar_faces(std::shared_ptr<const Accelerator> unordered,
                                                        const GeometryView &geometry, PlaneRules rules,
                                                        const BuildContext &context, MeshOwners owners = {});

// The priority order applied to rays: decides which of the coplanar faces at a place a ray hits or skips.
class PlaneRule {
public:
  PlaneRule(const GeometryView &geometry, const FaceRounding &rounding, CoplanarFaces faces, PlaneRules rules);

  bool flagged(const Hit &hit) const { return faces.has(hit.instance, hit.primitive); }
  // Tests the face that a ray starts on.
  bool flagged(const Ray &ray) const { return ray.skip_instance != kNone && faces.has(ray.skip_instance, ray.skip_primitive); }
  // By instance: 1 if some of its faces are flagged.
  const std::vector<uint8_t> &instances() const { return faces.instances; }
  // Returns whether faces of higher priority may cover emitting ones.
  bool any_hidden_light() const { return hides_light; }
  size_t bytes() const { return faces.bytes(); }

  PlaneOrder order_of(const Hit &hit) const { return plane_order(geometry, rules, hit.instance, hit.primitive); }
  bool emits(const Hit &hit) const { return face_emits(geometry, rules, hit.instance, hit.primitive); }

  // Returns whether a ray starts on a flagged face at a place that other faces may cover.
  bool starts_covered(const Ray &ray) const;
  // Returns whether a ray may end on a flagged face that emits.
  bool may_end_on_light(const Ray &ray) const;

  // The hits passed to the following functions must be flagged. Return whether a hit lies in the plane that the ray starts or
  // ends in, so that only rounding puts it on the ray.
  bool starts_in_plane(const Ray &ray, const Hit &hit) const;
  bool ends_in_plane(const Ray &ray, const Hit &hit) const;
  // Returns a ray along the last part of the given ray and somewhat beyond; its hits may lie at the given ray's end.
  static Ray around_end(const Ray &ray);

  // A ray across the plane of a hit that finds faces of possibly higher priority; none if there cannot be any.
  struct Across {
    Ray ray;
    FlatFace face;
    double reach; // distance from its origin to the plane
  };
  std::optional<Across> across(const Ray &ray, const Hit &hit) const;
  // Returns whether a hit of that ray is in the plane of the original hit.
  bool in_plane(const Across &across, const Hit &hit, const Hit &met) const;

private:
  double others(const glm::dvec3 &p) const;
  void find_light_planes();

  const GeometryView geometry;
  const FaceRounding rounding;
  const CoplanarFaces faces;
  const PlaneRules rules;
  std::vector<uint32_t> planes; // infinite planes that have such faces
  double widest = 0.0;          // largest rounding share of the other instances
  // Facts about the instances that have such faces:
  bool shines = false;          // one emits
  bool hides_light = false;     // one emits and is transparent, so that it has lower priority
  bool shines_anywhere = false; // an exact surface emits, or more planes emit than are worth a test each
  struct LightPlane {
    glm::dvec3 p, n;
    double reach;
  };
  std::vector<LightPlane> light_planes;
};

} // namespace lancer
