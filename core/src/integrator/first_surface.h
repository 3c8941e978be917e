// What the passes tell about the surfaces that the camera sees.
#pragma once

#include "integrator/light_passes.h"
#include "integrator/lobe_means.h"
#include "integrator/sample.h"
#include "integrator/shading.h"

namespace lancer {

// Fills where the camera ray has met a surface: depth, position and indices. t: of the camera ray.
void record_place(const Scene &scene, const Surface &surface, const Material *material, double t, SampleResult &result);
// As if it had met nothing.
void forget_place(SampleResult &result);
// All that the first surface says about the pixel.
void record_first_surface(const Scene &scene, const IntegratorSettings &settings, const Surface &surface, const Shaded &shaded,
                          double t, SampleResult &result);
// Fills what else the first surface says about the pixel. normal: the mean of the lobes'.
void record_first_surface(const Scene &scene, const IntegratorSettings &settings, const Surface &surface,
                          const glm::vec3 &normal, SampleResult &result);

// Takes what a holdout leaves out of the picture: a hole of `weight`. False where nothing of the surface is left, not even what
// passes straight through it.
bool cut_hole(const Scene &scene, const Surface &surface, const glm::vec3 &weight, Shaded &shaded, SampleResult &result);

// Adds to the passes of mist and colours what the picture shows of a surface: `weight` of what light brings from there.
void record_seen(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const LightPasses &passes,
                 const Surface &surface, const Shaded &shaded, const glm::vec3 &weight, SampleResult &result);

// How much mist covers a point: 0 near, 1 far.
float mist_at(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Surface &surface);

} // namespace lancer
