// What passes say of the first surface: geometry, and the features that denoising needs.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/light_passes.h"
#include "integrator/stages/lobe_means.h"
#include "integrator/stages/shading.h"
#include "integrator/stages/surface_stage.h"

namespace lancer {

// What the passes tell about the surfaces that the camera sees.

// Fills where the camera ray has met a surface: depth, position and indices. t: of the camera ray.
void record_place(const Scene &scene, const Surface &surface, const Material *material, double t, SampleResult &result);
// As if it had met nothing.
void forget_place(SampleResult &result);
// Fills what else the first surface says about the pixel. normal: the mean of the lobes'.
void record_first_surface(const Scene &scene, const IntegratorSettings &settings, const Surface &surface,
                          const glm::vec3 &normal, SampleResult &result);

// Adds to the passes of mist and colours what the picture shows of a surface, that of a lane: `weight` of what light brings
// from there.
void record_seen(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const LightPasses &passes,
                 const Surface &surface, const SurfaceStage &stage, uint32_t lane, const glm::vec3 &weight,
                 SampleResult &result);

// How much mist covers a point: 0 near, 1 far.
float mist_at(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Surface &surface);

// Albedo, normal and depth for denoisers: of the first surface that is not mostly a mirror, seen through those before it; or,
// as Blender 5.2 has it, of all surfaces, each by how much of it is matt.

// What is left of a camera path's features after the mirrors so far.
struct DenoisingGuides {
  bool open = false; // the surface that counts is still to come
  bool first = true; // nothing has been met yet
  bool blended = false;
  float share = 1.0f; // of the pixel's sample, where a path has split
  glm::vec3 beta{1.0f};
};

// Of a camera path that begins.
DenoisingGuides begin_guides(const IntegratorSettings &settings, bool wanted);

// Takes in the surface at hand, which lies `distance` (normalised units) behind the last one.
void add_denoising_guides(const Scene &scene, const Camera &camera, const Mixture<float> &mixture, const glm::vec3 &wo,
                          const glm::vec3 &transmittance, double distance, DenoisingGuides &features, SampleResult &result);
// The camera sees the sky behind what let it pass.
void add_sky_guides(const DenoisingGuides &features, SampleResult &result);

} // namespace lancer
