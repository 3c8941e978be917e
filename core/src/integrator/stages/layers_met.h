// Surfaces that the rays of a batch meet and pass while they are under way: each once, whatever order they are found in.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"

#include <span>
#include <vector>

namespace lancer {

struct Layer {
  Hit hit;
  glm::vec3 transmittance{1.0f};
  uint32_t next = kNone; // of the same ray
};

class LayersMet {
public:
  explicit LayersMet(const Geometry &geometry) : geometry_(geometry) {}

  // Forgets everything; so many rays follow.
  void begin(size_t rays) {
    rays_.assign(rays, {});
    layers_.clear();
  }
  // Of a ray.
  uint32_t count(size_t ray) const { return rays_[ray].count; }
  // The layer that a ray has passed at this very place; null where there is none. Where triangles of a mesh meet, a ray
  // through their common edge or corner passes one surface, not several.
  Layer *find(size_t ray, const Hit &hit);
  // known: what find() has found for it. Where triangles meet, the closest stands for all.
  void put(Layer *known, size_t ray, const Hit &hit, const glm::vec3 &transmittance);
  // Those of a ray that are closer than a hit.
  uint32_t count_before(size_t ray, const Hit &hit) const;
  // Those of a ray, the closest first, until the next call; or only those that take some light.
  std::span<const Layer> in_order(size_t ray) { return sort(ray, true); }
  std::span<const Layer> dimming_in_order(size_t ray) { return sort(ray, false); }

private:
  struct RayLayers {
    uint32_t first = kNone, count = 0;
  };

  std::span<const Layer> sort(size_t ray, bool clear);

  const Geometry &geometry_;
  std::vector<RayLayers> rays_;
  std::vector<Layer> layers_;
  std::vector<Layer> sorted_;
};

} // namespace lancer
