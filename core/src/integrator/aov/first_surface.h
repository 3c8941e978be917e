// The passes of the first surface: geometry and the guides of denoising.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/light_passes.h"
#include "integrator/stages/lobe_means.h"
#include "integrator/stages/surface.h"

namespace lancer {

// Passes of the surfaces that the camera sees.

// Records the hit of the camera ray: depth, position and indices. t: of the camera ray.
void record_place(const Scene &scene, const Surface &surface, const MaterialView &material, double t, SampleResult &result);
// Resets the record to that of a ray that hits nothing.
void forget_place(SampleResult &result);
// Records the other passes of the first surface. normal: the mean of the lobes' normals.
void record_first_surface(const Scene &scene, const IntegratorSettings &settings, const Surface &surface,
                          const glm::vec3 &normal, SampleResult &result);

// Adds a lane's surface to the passes of mist and colours. weight: throughput from the surface to the camera.
void record_seen(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const LightPasses &passes,
                 const Surface &surface, const SurfaceStage &stage, uint32_t lane, const glm::vec3 &weight,
                 SampleResult &result);

// Returns the share of mist in front of a point: 0 near, 1 far.
float mist_at(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Surface &surface);

// Albedo, normal and depth for denoisers. They are those of the first surface that is not mostly a mirror, with the throughput
// of the surfaces before it. By the rule of Blender 5.2, they are those of all surfaces, weighted by their matt share.

// The state of a camera path's guides after the mirrors so far.
struct DenoisingGuides {
  bool open = false; // the surface that ends the search is still to come
  bool first = true; // no surface has been hit yet
  bool blended = false;
  bool scattered = false; // the path has been scattered before
  float share = 1.0f;     // of the pixel's sample, where a path has split
  double counted = 0.0;   // distance along the current ray that is already counted, normalised units
  glm::vec3 beta{1.0f};
};

// Returns the state at the start of a camera path.
DenoisingGuides begin_guides(const IntegratorSettings &settings, bool wanted);

// Adds the distance of a surface, in normalised units, from the start of the ray.
void add_guide_distance(const Scene &scene, const Camera &camera, const glm::vec3 &wo, double distance, DenoisingGuides &guides,
                        SampleResult &result);
// Adds the current surface with its distance.
void add_denoising_guides(const Scene &scene, const Camera &camera, const Mixture<float> &mixture, const glm::vec3 &wo,
                          const glm::vec3 &transmittance, double distance, DenoisingGuides &guides, SampleResult &result);
// Records the sky behind transparent surfaces.
void add_sky_guides(const DenoisingGuides &guides, SampleResult &result);

} // namespace lancer
