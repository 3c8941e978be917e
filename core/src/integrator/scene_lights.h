// One question for every kind of light: what arrives at a point from a sample of it.
#pragma once

#include "integrator/shading.h"

namespace lancer {

// light is a number of scene.lights; see LightSample.
LightSample sample_scene_light(const Scene &scene, uint32_t light, const glm::dvec3 &p, const glm::vec2 &u, Shader &shader);

} // namespace lancer
