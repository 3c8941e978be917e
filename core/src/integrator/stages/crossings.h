// Surfaces that the rays of a batch pass during traversal. Each surface is counted once; the traversal may find them in any
// order.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"

#include <span>
#include <vector>

namespace lancer {

struct Crossing {
  Hit hit;
  glm::vec3 transmittance{1.0f};
  uint32_t next = kNone; // of the same ray
};

class Crossings {
public:
  explicit Crossings(const Geometry &geometry) : geometry_(geometry) {}

  // Clears all crossings for the next batch of rays.
  void begin(size_t rays) {
    rays_.assign(rays, {});
    crossings_.clear();
  }
  // Returns the number of crossings of a ray.
  uint32_t count(size_t ray) const { return rays_[ray].count; }
  // Returns the ray's crossing at the place of the hit; null if there is none. A ray through a common edge or corner of a
  // mesh's triangles passes one surface, not several.
  Crossing *find(size_t ray, const Hit &hit);
  // known: result of find() for the hit. Where triangles meet, the closest one represents all.
  void put(Crossing *known, size_t ray, const Hit &hit, const glm::vec3 &transmittance);
  // Returns the number of crossings of a ray that are closer than a hit.
  uint32_t count_before(size_t ray, const Hit &hit) const;
  // Return the crossings of a ray, the closest first, valid until the next call: all of them, or only those that absorb light.
  std::span<const Crossing> in_order(size_t ray) { return sort(ray, true); }
  std::span<const Crossing> dimming_in_order(size_t ray) { return sort(ray, false); }

private:
  struct RayCrossings {
    uint32_t first = kNone, count = 0;
  };

  std::span<const Crossing> sort(size_t ray, bool clear);

  const Geometry &geometry_;
  std::vector<RayCrossings> rays_;
  std::vector<Crossing> crossings_;
  std::vector<Crossing> sorted_;
};

} // namespace lancer
