// The discs of the sun in a world: where its nodes SKY show them, for sampling.
#pragma once

#include "nodes/block.h"
#include "scene/light.h"

#include <vector>

namespace lancer {

struct Sun {
  glm::dvec3 axis{0.0, 0.0, 1.0}; // world, unit
  double half_angle = 0.0;        // a little more than the disc's
  uint32_t node = 0;
};

// Returns the suns that are discs: of nodes SKY whose direction is that of the ray, rotated or mirrored by any nodes.
std::vector<Sun> find_suns(const WorldView &world, const NodeScene &scene);

// Returns the nodes of the world without these suns' discs.
std::vector<Node> without_suns(const WorldView &world, const std::vector<Sun> &suns);

} // namespace lancer
