// The extras of the surfaces and the sky that the camera sees: mattes and outputs.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/surface.h"

namespace lancer {

// Adds the mattes of a surface. share: of the pixel's sample that the surface covers.
inline void add_mattes(const Scene &scene, const ExtraLayout &layout, uint32_t sample, uint32_t instance,
                       const MaterialView &material, float share, Extras &extras) {
  if (!layout.mattes || !(share > 0.0f))
    return;
  const Instance &object = scene.geometry.instances[instance];
  extras.mattes.push_back({sample, share, {object.object_matte, material.matte, object.asset_matte}});
}

// Adds the value of an output. NaN counts as 0.
inline void add_output(const ExtraLayout &layout, uint32_t sample, const Output &output, const glm::vec3 &value,
                       Extras &extras) {
  if (output.number >= (output.is_color ? layout.colors : layout.values))
    return;
  float *const channels = extras.channels.data() + size_t(sample) * layout.channels();
  const auto finite = [](float x) { return x == x ? within(x, -kBrightest, kBrightest) : 0.0f; };
  if (!output.is_color) {
    channels[layout.value(output.number)] += finite(value.x);
    return;
  }
  float *const to = channels + layout.color(output.number);
  for (int i = 0; i < 3; ++i)
    to[i] += finite(value[i]);
  to[3] += 1.0f;
}

// Adds the outputs of a lane's surface, whose nodes have been asked with outputs.
inline void add_outputs(const ExtraLayout &layout, uint32_t sample, const SurfaceStage &surfaces, uint32_t lane,
                        Extras &extras) {
  for (const Output &output : surfaces.material(lane).outputs)
    add_output(layout, sample, output, surfaces.value(output.value, lane), extras);
}

// Adds the outputs of the world where a ray of the camera sees it. As in Cycles, only nodes make the world give its outputs,
// and it gives none where only its absence is seen: behind a transparent film without a pass of the environment. wi: unit;
// eye: where the ray starts; values: room for all nodes of the world.
void add_sky_outputs(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, uint32_t sample,
                     const glm::dvec3 &wi, const glm::dvec3 &eye, const LightPath<float> &path, std::span<glm::vec4> values,
                     Extras &extras);

} // namespace lancer
