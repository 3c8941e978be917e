#include "integrator/scene_lights.h"

namespace lancer {

LightSample sample_scene_light(const Scene &scene, uint32_t light, const glm::dvec3 &p, const glm::vec2 &u, Shader &shader) {
  const size_t described = scene.lights.lights().size();
  if (light < described)
    return sample(scene.lights.lights()[light], p, u);
  if (light - described >= scene.lights.emitters().size())
    return scene.lights.environment().sample(u, shader.values(), shader.camera());
  // Ask the material of the emitter's surface what it sends towards p.
  Surface surface;
  LightSample result =
      scene.lights.emitters()[light - described].sample(scene.geometry, scene.slots, scene.materials, p, u, surface);
  if (result.pdf > 0.0)
    result.radiance = shader.emission(surface, glm::vec3(-result.wi));
  return result;
}

} // namespace lancer
