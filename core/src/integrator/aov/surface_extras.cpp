#include "integrator/aov/surface_extras.h"

namespace lancer {

void add_sky_outputs(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, uint32_t sample,
                     const glm::dvec3 &wi, const glm::dvec3 &eye, const LightPath<float> &path, std::span<glm::vec4> values,
                     Extras &extras) {
  const WorldView &world = scene.world;
  const bool hidden = settings.film_transparent && !(settings.passes & bit(Pass::Environment));
  if (world.outputs.empty() || hidden || (world.hidden_from & RayKind::Camera))
    return;
  scene.lights.environment().run_outputs(wi, values, &camera, &eye, path);
  for (const Output &output : world.outputs)
    add_output(settings.extras(), sample, output, value_of(output.value, values), extras);
}

} // namespace lancer
