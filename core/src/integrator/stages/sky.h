// The environment for lanes of directions: its radiance there, and directions sampled by its brightness.
//
// In: directions or random numbers, and the Light Path of each lane, from the stages light and met light. Out: radiance, and
// densities per solid angle.
#pragma once

#include "compile/scene.h"
#include "nodes/run.h"
#include "simd/block.h"

namespace lancer {

// Directions to the environment, and the density with which its map gives them.
struct alignas(64) SkyBlock {
  Floats u[2];
  Doubles wi[3], pdf; // wi: unit
};

class SkyStage {
public:
  SkyStage(const Scene &scene, const Camera *camera);

  // Samples directions into block, from its numbers u. The environment must be a light. transmits: whether the surfaces may
  // transmit light, which decides the map.
  void sample(SkyBlock &block, bool transmits) const;
  // Computes the densities of the block's directions.
  void find_density(SkyBlock &block, bool transmits) const;

  // Evaluates the environment: set the path of each lane, look, then read the results. eye: where a camera ray begins, null for
  // any other ray.
  void set_path(uint32_t lane, const LightPath<float> &path, const glm::dvec3 *eye) {
    nodes_.eye[lane] = eye;
    put(path, nodes_, lane);
  }
  void look(const Doubles (&wi)[3], uint32_t lanes);
  glm::vec3 radiance(uint32_t lane) const {
    const auto &value = values_[size_t(scene_.world.radiance.node)].of;
    return {value[0][lane], value[1][lane], value[2][lane]};
  }

private:
  const Scene &scene_;
  DirectionTable maps_[2]; // by transmits
  NodeBlock nodes_;
  std::vector<NodeLanes> values_;
};

} // namespace lancer
