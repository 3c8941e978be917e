// A white lamp around the origin, for tests.
#pragma once

#include "lights/light.h"

namespace lancer::testing {

// soft: with Blender's Soft Falloff.
inline Light ball(double radius, bool soft) {
  Light light;
  light.kind = LightKind::Point;
  light.emission = glm::dvec3(1.0);
  light.radius = radius;
  light.soft_falloff = soft;
  return light;
}

} // namespace lancer::testing
