// Surfaces that the rays of a batch meet and pass while they are under way: each once, whatever order they are found in.
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

  // Forgets everything; so many rays follow.
  void begin(size_t rays) {
    rays_.assign(rays, {});
    crossings_.clear();
  }
  // Of a ray.
  uint32_t count(size_t ray) const { return rays_[ray].count; }
  // The layer that a ray has passed at this very place; null where there is none. Where triangles of a mesh meet, a ray
  // through their common edge or corner passes one surface, not several.
  Crossing *find(size_t ray, const Hit &hit);
  // known: what find() has found for it. Where triangles meet, the closest stands for all.
  void put(Crossing *known, size_t ray, const Hit &hit, const glm::vec3 &transmittance);
  // Those of a ray that are closer than a hit.
  uint32_t count_before(size_t ray, const Hit &hit) const;
  // Those of a ray, the closest first, until the next call; or only those that take some light.
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
