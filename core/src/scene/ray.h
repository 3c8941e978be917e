// Input and output of every accelerator.
#pragma once

#include "scene/enums.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace lancer {

inline constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

// Bits of Ray::kinds and of hidden_from. Each kind of ray has a second bit for rays among shadow catchers alone, from which all
// other objects and their light are hidden.
inline constexpr uint32_t kCatcherShift = 16;
inline constexpr uint32_t kOfCatchers = (2u * RayKind::Raycast - 1u) << kCatcherShift;
inline constexpr uint32_t kCameraKinds = RayKind::Camera | RayKind::Camera << kCatcherShift;
constexpr uint32_t among_catchers(uint32_t kinds) { return kinds << kCatcherShift; }
// Returns what is hidden from rays of both sorts, of an object or a light that is hidden from these kinds.
constexpr uint32_t hidden_of_catcher(uint32_t hidden_from) { return hidden_from | among_catchers(hidden_from); }
constexpr uint32_t hidden_of_other(uint32_t hidden_from) { return hidden_from | kOfCatchers; }

// Points o + t d with tmin < t < tmax, in the normalised world. d need not be unit: t is in units of its length. All in double:
// a hit point keeps the digits of the surface, so that no visible offset is needed.
struct Ray {
  glm::dvec3 o{0.0};
  double tmin = 0.0;
  glm::dvec3 d{0.0, 0.0, 1.0};
  double tmax = std::numeric_limits<double>::infinity();
  // The primitive on which the ray starts; kNone if there is none. A flat one is not hit again; on an exact surface, the place
  // of the origin is skipped.
  uint32_t skip_instance = kNone;
  uint32_t skip_primitive = kNone;
  // Bits of RayKind: the kind of the ray; or their second bits. A ray passes an object that is hidden from all of its kinds as
  // if the object did not exist.
  uint32_t kinds = ~0u;
  // When the ray meets things that move: see scene/motion.h.
  float time = 0.5f;
};

// primitive: index into Mesh::triangles; 0 for exact surfaces.
// u, v: barycentric weights of the triangle's corners 1 and 2; 0 for exact surfaces.
struct Hit {
  double t = std::numeric_limits<double>::infinity();
  double u = 0.0, v = 0.0;
  uint32_t instance = kNone;
  uint32_t primitive = kNone;

  bool valid() const { return instance != kNone; }
};

// A filter of hits. Rejected hits are skipped as if they did not exist: the ray continues within the same traversal, and may
// hit an exact surface again where it leaves it.
class HitFilter {
public:
  // asked: by instance, 0 if every hit counts, without a call.
  explicit HitFilter(const uint8_t *asked) : instances(asked) {}
  // Returns whether a hit of rays[ray] of the batch counts. Called in any order, possibly more than once, for
  // - closest hit: every hit that is closer, by closer(), than the closest that counts, and some that are not;
  // - any hit: all hits of a ray that is not occluded.
  // The result for a hit may depend on earlier calls only if the caller does not depend on the order of hits.
  virtual bool counts(size_t ray, const Hit &hit) = 0;

  const uint8_t *instances; // by instance: 1 if counts() decides on its hits

protected:
  ~HitFilter() = default;
};

// The work of a traversal for a batch of rays.
struct TraversalCounts {
  uint64_t nodes = 0, triangle_blocks = 0, sphere_blocks = 0, instances = 0;
};

// Defines the closest hit uniquely, but for the order of coplanar faces: smaller t, then smaller instance, then smaller
// primitive.
[[gnu::always_inline]] inline bool closer(double t, uint32_t instance, uint32_t primitive, const Hit &best) {
  if (t != best.t)
    return t < best.t;
  if (instance != best.instance)
    return instance < best.instance;
  return primitive < best.primitive;
}

} // namespace lancer
