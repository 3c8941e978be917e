// The next hits of rays: one traversal passes all surfaces that are absent by their transmittance (compile/cutout.h), such as
// leaves cut out by an image. A surface that lets only a part of the light pass is a hit.
//
// In: rays, and the number of surfaces that each may still pass, from an integrator. Out: hits, for the met lights, the shading
// queues and the film, and the absent surfaces that rays have passed before their hits. At an absent surface, shading would
// continue the path straight through with weight 1 and sample no light. Rays are in the normalised world. Caller: PATH; the
// shadow stage has Crossings of its own; accel/accelerator.h finds the hits.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/shader.h"
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
  explicit Crossings(const GeometryView &geometry) : geometry_(geometry) {}

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

  const GeometryView geometry_;
  std::vector<RayCrossings> rays_;
  std::vector<Crossing> crossings_;
  std::vector<Crossing> sorted_;
};

class HitStage final : HitFilter {
public:
  HitStage(const Scene &scene, const Camera &camera);

  // Whether rays may pass absent surfaces in one traversal, so that find() needs left.
  bool crosses() const { return crosses_; }
  // Finds the closest hits. left: by ray, the number of surfaces that the ray may pass.
  void find(std::span<const Ray> rays, std::span<const uint32_t> left, std::vector<Hit> &hits);
  // Returns the number of absent surfaces that a ray of the last batch has passed before its hit.
  uint32_t passed(size_t ray, const Hit &hit) const {
    return crossings_.count(ray) > 0 ? crossings_.count_before(ray, hit) : 0;
  }
  // Returns the absent surfaces on a ray, the closest first, valid until the next call; some may lie beyond its hit.
  std::span<const Crossing> absent(size_t ray) { return crossings_.in_order(ray); }

private:
  // Whether a hit ends the search: its surface is present, see Shader::is_there(), or its ray may pass no more. Otherwise
  // stores the crossing.
  bool counts(size_t ray, const Hit &hit) override;

  const Scene &scene_;
  Shader shader_;
  Crossings crossings_;
  bool crosses_;
  std::span<const uint32_t> left_;
};

} // namespace lancer
