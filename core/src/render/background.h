// The background of a picture, where pixels show nothing else and need not be traced.
#pragma once

#include "integrator/sample.h"
#include "render/coverage.h"
#include "render/film.h"

namespace lancer {

struct Background {
  Coverage coverage;
  SampleResult sample = SampleResult(); // of every pixel that is not covered
};

// camera: normalised. Returns a coverage of all pixels where the background varies, where few samples are planned, or where all
// features are requested.
Background find_background(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Film &film);

// Whether all camera rays that miss the scene return the same radiance.
bool has_even_background(const Scene &scene, const Camera &camera);

} // namespace lancer
