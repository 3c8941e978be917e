// The rays of nodes that look around a surface (nodes/looking.h), traced in the scene.
//
// In: rays of nodes, one after the other, from the surface stage while the nodes of a block run. Out: their hits. Rays are in
// the normalised world. Caller: the surface stage of PATH.
#pragma once

#include "integrator/stages/own_hits.h"
#include "nodes/looking.h"

namespace lancer {

// Stays in its place: its functions refer to it.
class SceneNodeRays {
public:
  explicit SceneNodeRays(const Scene &scene);
  SceneNodeRays(const SceneNodeRays &) = delete;
  SceneNodeRays &operator=(const SceneNodeRays &) = delete;

  const NodeRays &functions() const { return functions_; }

private:
  uint32_t open(std::span<const Ray> rays, uint32_t instance);
  Hit closest(const Ray &ray, uint32_t instance);
  std::span<const Hit> all(const Ray &ray, uint32_t instance);
  Surface surface(const Ray &ray, const Hit &hit) const;

  NodeRays functions_;
  const Scene &scene_;
  OwnHits own_;
};

} // namespace lancer
