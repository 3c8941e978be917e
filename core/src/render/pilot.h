// The pilot: finds, from a few pixels, how samples split before the first sample of a picture.
#pragma once

#include "integrator/sample.h"
#include "render/coverage.h"

#include <barrier>
#include <cstddef>
#include <memory>
#include <vector>

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

// Renders some pixels of the whole image with different splits and chooses the splits of the least variance times cost. The
// pilot's samples are discarded: a picture that keeps samples on which a decision was based would be biased. Variance is
// estimated from halves, like the error of a picture; cost is counted in rays and vertices. So the result depends neither on
// threads, nor on clocks, nor on the seed or the rendered region.
class Pilot {
public:
  // Below this number of planned samples, the pilot costs more time than it saves.
  static constexpr uint32_t kLeastPlanned = 16;

  // All references must outlive the pilot. background: pixels that need not be traced; it changes only the time. threads: the
  // number of threads that will call work().
  Pilot(const Scene &scene, const Camera &camera, const Background &background, const IntegratorSettings &settings,
        uint32_t threads);

  // All threads must call work() once, at the same time; each call returns when the splits are found.
  void work(uint32_t thread);
  // The result, valid after work().
  const Splits &splits() const { return best_; }

private:
  // A pixel that has noise.
  struct Pixel {
    uint32_t x, y;
    double level = 0.0; // sum over all measurements of the mean luminance
  };
  // The measurement of one way of splitting.
  struct Look {
    Splits splits;
    std::vector<double> noise; // [pixel]
    uint64_t cost = 0;
  };

  void search();
  Look find_pixels();
  bool is_empty(const Pixel &pixel) const;
  Look look(const Splits &splits);
  bool is_better(const Look &look, const Look &than, double by) const;
  uint64_t run(const std::vector<Pixel> &pixels, const Splits &splits);
  double mean_of(size_t pixel) const;
  double noise_of(size_t pixel) const;
  void measure(uint32_t thread);

  const Scene &scene_;
  const Camera &camera_;
  const Background &background_;
  IntegratorSettings settings_;
  std::vector<Pixel> pixels_;
  uint32_t looks_ = 0;          // number of measurements in level
  double darkest_ = 0.0;        // added to every level
  uint64_t cost_of_others_ = 0; // of pixels without noise, independent of the splits
  // The current measurement.
  Splits tried_;
  std::vector<SampleAddress> addresses_;                 // [pixel][sample]
  std::vector<float> luminances_;                        // of each address
  std::vector<std::unique_ptr<Integrator>> integrators_; // by thread
  std::vector<uint64_t> costs_;                          // of each thread
  std::atomic<size_t> next_batch_{0};
  Splits best_;
  std::atomic<bool> done_{false};
  std::barrier<> barrier_;
};

} // namespace lancer
