// The rays of nodes that look around a surface (nodes/looking.h), traced in the scene.
//
// In: rays of nodes, one after the other, from the surface stage while the nodes of a block run. Out: their hits. Rays are in
// the normalised world. Caller: the surface stage of PATH.
#pragma once

#include "compile/scene.h"
#include "nodes/looking.h"

namespace lancer {

class SceneNodeRays final : public NodeRays, HitFilter {
public:
  explicit SceneNodeRays(const Scene &scene);

  uint32_t open(std::span<const Ray> rays, uint32_t instance) override;
  Hit closest(const Ray &ray, uint32_t instance) override;
  std::span<const Hit> all(const Ray &ray, uint32_t instance) override;
  Surface surface(const Ray &ray, const Hit &hit) const override;

private:
  // Whether a hit belongs to the instance; collects it, and lets the ray go on, where all hits are wanted.
  bool counts(size_t ray, const Hit &hit) override;

  const Scene &scene_;
  const Accelerator &alone_;   // for one instance: faces of others hide none of its own
  std::vector<uint8_t> asked_; // HitFilter::instances: all
  uint32_t instance_ = kNone;
  bool collects_ = false;
  std::vector<Hit> hits_;
};

} // namespace lancer
