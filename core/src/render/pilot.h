// The pilot: finds, from a few pixels, how samples split before the first sample of a picture.
#pragma once

#include "render/background.h"

#include <barrier>
#include <memory>
#include <vector>

namespace lancer {

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
