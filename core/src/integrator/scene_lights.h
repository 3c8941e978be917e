// One question for every kind of light: what arrives at a point from a sample of it.
#pragma once

#include "integrator/shading.h"

namespace lancer {

// choice: of scene.lights; see LightSample. pdf is that of the point once light and face are chosen.
LightSample sample_scene_light(const Scene &scene, const LightSet::Choice &choice, const glm::dvec3 &p, const glm::vec2 &u,
                               Shader &shader);
// All of a light by itself, number light of scene.lights: of an emitter, a face by its power.
LightSample sample_scene_light(const Scene &scene, uint32_t light, const glm::dvec3 &p, const glm::vec2 &u, Shader &shader);

// What the scene's surfaces emit, for commit(); by one thread at a time. The scene must outlive the answer.
EmissionAt surface_emission(const Scene &scene);

} // namespace lancer
