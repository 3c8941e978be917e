// What a picture shows where it shows nothing else, where that need not be traced.
#pragma once

#include "integrator/sample.h"
#include "render/coverage.h"
#include "render/film.h"

namespace lancer {

struct Background {
  Coverage coverage;
  SampleResult sample = SampleResult(); // of every pixel that is not covered
};

// camera: normalised. Where the background varies, few samples are planned, or features are not to be left out, everything may
// be covered.
Background find_background(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Film &film);

// Whether all camera rays that meet nothing show the same.
bool has_even_background(const Scene &scene, const Camera &camera);

} // namespace lancer
