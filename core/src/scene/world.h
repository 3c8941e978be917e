// What lies beyond everything, as described: one radiance, or nodes over the direction.
#pragma once

#include "scene/node.h"

#include <optional>

namespace lancer {

struct World {
  Program program;
  Parameter radiance;
  Schedule schedule;                // of radiance
  uint32_t hidden_from = 0;         // LANCER_RAY_* bits
  uint32_t map_resolution = 0;      // 0 = by its images
  std::optional<glm::vec3> ambient; // in place of the mean radiance, for Ka

  bool varies() const { return radiance.varies(); }
};

} // namespace lancer
