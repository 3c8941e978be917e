// The measured numbers of the pilot: the cost of samples, and the size and the rule of its search.
#pragma once

#include "integrator/sample.h"

#include <cstddef>

namespace lancer {

// The cost of samples, in proportion to the time that they take:
//   cost = camera_ray * camera rays + ray * (bounce rays + shadow rays) + vertex * vertices.
// The weights are fitted to the times of 26 public files, each with four ways of splitting, and predict the ratios of times
// within a file to 10 % (one standard deviation). `make pilot` repeats the fit on the project's scenes: over seventeen of them,
// both these weights and the fitted ones predict to 6 %, and the fit gives -5 to 8, 20 (fixed) and 8 to 23 (95 %). The weights
// are whole numbers, so that a sum over threads is the same in any order.
struct CostModel {
  uint64_t camera_ray = 4;
  uint64_t ray = 20;
  uint64_t vertex = 15;

  constexpr uint64_t of(const RayCounts &rays, uint64_t vertices) const {
    return camera_ray * rays.camera + ray * (rays.bounce + rays.shadow) + vertex * vertices;
  }
};

// The search doubles the numbers of lights and paths as long as
//   variance(next) * cost(next) < gain * variance(best) * cost(best).
// The variance is the sum over the pilot's pixels of each pixel's noise, relative to the square of the pixel's level.
struct PilotModel {
  CostModel cost;
  // Samples of each pixel of the pilot. The variance of two paths over that of one is 0.47 to 0.54 in pictures of 64 samples
  // (six public files). A pilot of 32 samples reports 0.42 to 0.77; one of 16 samples reports 0.52 to 1.06 and so
  // underestimates the gain of splitting.
  uint32_t samples = 32;
  // Samples of the picture for each pixel of the pilot, whose number stays within the two bounds. The pilot lengthens a render
  // by 1 to 9 % (64 samples, seven public files), and by 18 % where the render takes 0.05 s; `make pilot` measures it, too.
  double samples_per_pixel = 4096.0;
  uint32_t fewest_pixels = 128, most_pixels = 1024;
  // Number of pixels with noise that the pilot searches for, and the largest number of sets of pixels that it renders to find
  // them.
  size_t fewest_noisy = 160;
  uint32_t most_rounds = 16;
  // The largest number of lights or paths in the search.
  uint32_t most_splits = 8;
  // Required gain: a split that gains less only delays the first pictures.
  double gain = 0.95;
  // Share of the pixels, the noisiest ones, whose noise is clamped to the smallest value among them: so few samples contain too
  // few bright flashes to estimate their variance.
  double clamped = 0.005;
};

inline constexpr PilotModel kPilot;

} // namespace lancer
