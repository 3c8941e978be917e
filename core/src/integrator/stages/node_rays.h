// The rays of nodes that look around a surface (nodes/looking.h), traced in the scene.
//
// In: rays of nodes, one after the other, from the surface stage while the nodes of a block run. Out: their hits. Rays are in
// the normalised world. Caller: the surface stage of PATH.
#pragma once

#include "integrator/stages/own_hits.h"
#include "nodes/looking.h"

namespace lancer {

class SceneNodeRays final : public NodeRays {
public:
  explicit SceneNodeRays(const Scene &scene) : scene_(scene), own_(scene) {}

  uint32_t open(std::span<const Ray> rays, uint32_t instance) override;
  Hit closest(const Ray &ray, uint32_t instance) override;
  std::span<const Hit> all(const Ray &ray, uint32_t instance) override;
  Surface surface(const Ray &ray, const Hit &hit) const override;

private:
  const Scene &scene_;
  OwnHits own_;
};

} // namespace lancer
