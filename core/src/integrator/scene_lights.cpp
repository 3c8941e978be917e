#include "integrator/scene_lights.h"

namespace lancer {

namespace {

// face: null, by power.
LightSample sample_any(const Scene &scene, uint32_t light, const uint32_t *face, const glm::dvec3 &p, const glm::vec2 &u,
                       Shader &shader) {
  const size_t described = scene.lights.lights().size();
  if (light < described)
    return sample(scene.lights.lights()[light], p, u);
  if (light - described >= scene.lights.emitters().size())
    return scene.lights.environment().sample(u, shader.values(), shader.camera());
  // Ask the material of the emitter's surface what it sends towards p.
  const Emitter &emitter = scene.lights.emitters()[light - described];
  Surface surface;
  LightSample result = face ? emitter.sample_face(scene.geometry, scene.slots, *face, p, u, surface)
                            : emitter.sample(scene.geometry, scene.slots, p, u, surface);
  if (result.pdf > 0.0)
    result.radiance = shader.emission(surface, glm::vec3(-result.wi));
  return result;
}

} // namespace

LightSample sample_scene_light(const Scene &scene, const LightSet::Choice &choice, const glm::dvec3 &p, const glm::vec2 &u,
                               Shader &shader) {
  return sample_any(scene, choice.light, &choice.face, p, u, shader);
}

LightSample sample_scene_light(const Scene &scene, uint32_t light, const glm::dvec3 &p, const glm::vec2 &u, Shader &shader) {
  return sample_any(scene, light, nullptr, p, u, shader);
}

EmissionAt surface_emission(const Scene &scene) {
  const auto shader = std::make_shared<Shader>(scene, nullptr);
  return [shader](const Surface &surface, const glm::vec3 &wo) { return shader->emission(surface, wo); };
}

} // namespace lancer
