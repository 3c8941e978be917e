// The question and the answer of every accelerator.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace lancer {

inline constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

// Points o + t d with tmin < t < tmax, in the normalised world. d need not be unit: t is in units of its length.
// Double throughout: a hit point keeps the digits that the surface has, so that no visible offset is ever needed.
struct Ray {
  glm::dvec3 o{0.0};
  double tmin = 0.0;
  glm::dvec3 d{0.0, 0.0, 1.0};
  double tmax = std::numeric_limits<double>::infinity();
  // The flat primitive that the ray starts on: it cannot be met again. kNone: none.
  uint32_t skip_instance = kNone;
  uint32_t skip_primitive = kNone;
  // Bits of LANCER_RAY_*: what sent it. A thing hidden from all of them is not there.
  uint32_t kinds = ~0u;
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

// Decides whether what a ray meets counts. Other hits are left out as if they were not there: the ray goes on within the same
// traversal, and an exact surface is met again where the ray leaves it.
struct HitFilter {
  const uint8_t *instances; // by instance: 0 where every hit counts, unasked
  // Of rays[ray] of the batch. Asked in any order and maybe more than once about
  // - every hit that is closer than the closest that counts, by closer(), and some that are not;
  // - any hit at all: all hits of a ray that is not occluded.
  // What did not count may count after other hits have been asked about, where the order makes no difference to the asker.
  bool (*counts)(void *context, size_t ray, const Hit &hit);
  void *context;
};

// What a batch of rays had to look at on its way.
struct TraversalCounts {
  uint64_t nodes = 0, triangle_blocks = 0, sphere_blocks = 0, instances = 0;
};

// The rule that makes "closest" unique: smaller t, then smaller instance, then smaller primitive.
[[gnu::always_inline]] inline bool closer(double t, uint32_t instance, uint32_t primitive, const Hit &best) {
  if (t != best.t)
    return t < best.t;
  if (instance != best.instance)
    return instance < best.instance;
  return primitive < best.primitive;
}

} // namespace lancer
