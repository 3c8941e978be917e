// The frame in which scenes are traced, whatever their size and place.
#pragma once

#include "scene/affine.h"

namespace lancer {

// p_normalised = (p_world - centre) * scale, scale a power of two: the same scene at any size and place becomes the same
// numbers.
struct Normalisation {
  glm::dvec3 centre{0.0};
  double scale = 1.0;

  glm::dvec3 to_normalised(const glm::dvec3 &p) const { return (p - centre) * scale; }
  glm::dvec3 to_world(const glm::dvec3 &p) const { return p / scale + centre; }
  Affine to_normalised(const Affine &map) const { return {map.linear * scale, to_normalised(map.translation)}; }
};

} // namespace lancer
