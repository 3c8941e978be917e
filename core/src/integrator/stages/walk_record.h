// A walk below a surface, as the stages walk and profile and PATH share it.
#pragma once

#include "scene/lobe_inputs.h"
#include "scene/ray.h"

namespace lancer {

// A walk: its entry, and where it ends.
struct Walk {
  // In. The ray from the entry into the object; of Burley's profile, its origin alone.
  Ray ray;
  glm::vec3 n{0.0f};    // normal of the entry, against the walk, unit
  glm::vec3 beta{0.0f}; // throughput, with the colour of the surface; out: throughput at the end
  glm::vec3 color{0.0f}, radius{0.0f};
  float g = 0.0f, ior = 1.4f;
  SubsurfaceMethod method = SubsurfaceMethod::RandomWalk;
  // The number that chooses the channel to walk for, and that of the first distance: evenly spread over the samples of a pixel.
  float u_channel = 0.0f, u_distance = 0.0f;
  uint32_t key = 0; // of its other numbers
  uint32_t instance = kNone;
  bool from_behind = false; // the path has met the surface from behind, so that the walk is on its outer side
  // Out. The hit on the ray that ends the walk, from outside.
  Hit hit;
};

} // namespace lancer
