// The uniform background of a picture: pixels that show nothing else share one sample and are not traced.
#pragma once

#include "integrator/sample.h"
#include "render/coverage.h"
#include "render/film.h"

namespace lancer {

struct Background {
  Coverage coverage;
  SampleResult sample = SampleResult(); // of every pixel that is not covered
};

// camera: normalised. Returns a coverage of all pixels if the background varies, if few samples are planned, or if all features
// are requested.
Background find_background(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Film &film);

// Whether all camera rays that miss the scene return the same radiance.
bool has_even_background(const Scene &scene, const Camera &camera);

} // namespace lancer
