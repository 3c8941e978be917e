// What the passes tell about the surfaces that the camera sees.
#pragma once

#include "integrator/sample.h"
#include "integrator/shading.h"

namespace lancer {

// Fills where the camera ray has met a surface: depth, position and indices. t: of the camera ray.
void record_place(const Scene &scene, const Surface &surface, const Shaded &shaded, double t, SampleResult &result);
// As if it had met nothing.
void forget_place(SampleResult &result);
// Fills all that the first surface says about the pixel.
void record_first_surface(const Scene &scene, const IntegratorSettings &settings, const Surface &surface, const Shaded &shaded,
                          double t, SampleResult &result);

// How much mist covers a point: 0 near, 1 far.
float mist_at(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Surface &surface);

} // namespace lancer
