// The next hits of rays: one traversal passes all surfaces that an image has cut away.
//
// In: rays, and the number of surfaces that each may still pass, from an integrator. Out: hits, for the shading queues, and the
// absent surfaces that rays have passed before their hits. At an absent surface, shading would continue the path straight
// through with weight 1 and sample no light.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/crossings.h"
#include "integrator/stages/shader.h"

namespace lancer {

class HitStage final : HitFilter {
public:
  // passes: whether rays may pass absent surfaces in one traversal; otherwise they hit them.
  HitStage(const Scene &scene, const Camera &camera, bool passes);

  // Whether rays may pass absent surfaces, so that find() needs left.
  bool passes() const { return passes_; }
  // Finds the closest hits. left: by ray, the number of surfaces that the ray may pass.
  void find(std::span<const Ray> rays, std::span<const uint32_t> left, std::vector<Hit> &hits);
  // Returns the number of absent surfaces that a ray of the last batch has passed before its hit.
  uint32_t passed(size_t ray, const Hit &hit) const {
    return crossings_.count(ray) > 0 ? crossings_.count_before(ray, hit) : 0;
  }
  // Returns the absent surfaces on a ray, the closest first, valid until the next call; some may lie beyond its hit.
  std::span<const Crossing> absent(size_t ray) { return crossings_.in_order(ray); }

private:
  // Whether a surface is present at a hit.
  bool counts(size_t ray, const Hit &hit) override;

  const Scene &scene_;
  Shader shader_;
  Crossings crossings_;
  bool passes_;
  std::span<const uint32_t> left_;
};

} // namespace lancer
