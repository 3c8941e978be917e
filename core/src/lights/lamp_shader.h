// Lamps with nodes: the point of a lamp at which nodes say how strong the lamp shines, and their evaluation there.
#pragma once

#include "lights/light.h"
#include "nodes/run.h"
#include "scene/geometry.h"

#include <span>
#include <vector>

namespace lancer {

struct LampShader {
  ProgramView program;
  Parameter strength;        // factor of the lamp's emission
  ScheduleView schedule;     // of strength
  glm::dvec3 across, up;     // AREA: a side is at 1/2 along these; SUN: of its disk, as rows of the map to the lamp's frame
  double cotangent = 0.0;    // SPOT: half the cotangent of half its angle
  double inverse_sine = 0.0; // SUN: half over the sine of a quarter of its angle; 0 for a single direction
};

// The shaders by Light::shader, and the frames in which their nodes read places: one instance for each shader.
struct LampShaders {
  std::vector<LampShader> of;
  std::vector<Instance> places;
  GeometryView frames; // its instances are places

  bool empty() const { return of.empty(); }
};

// The input of a lamp's nodes, in the normalised world.
struct LampPoint {
  glm::dvec3 p{0.0};
  glm::vec3 n{0.0f}, wo{0.0f}; // unit, on the side of the lit place
  glm::dvec2 bary{0.0};        // of which Parametric gives the lamp's texture coordinates
  float length = 0.0f;         // to the lit place, in the user's units
};

// target: as LightSample::target; distance: to it, infinite for a sun.
LampPoint lamp_point(const Light &light, const LampShaders &shaders, const glm::dvec3 &target, const glm::dvec3 &wi,
                     double distance, const Normalisation &normalisation);

// Returns the mean absolute strength over the directions that a lamp shines in, the weight of its light in a choice: at least a
// small share of 1, because its nodes may be bright between the places looked at.
double mean_strength(const Light &light, const LampShaders &shaders, const NodeScene &scene);

} // namespace lancer
