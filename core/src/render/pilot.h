// How samples split: found out by a few pixels, before the first sample of a picture.
#pragma once

#include "render/background.h"

#include <barrier>
#include <memory>
#include <vector>

namespace lancer {

// Renders some pixels of the whole image with one way of splitting after the other, and takes the one whose variance times cost
// is least. Its own samples are thrown away: a picture whose samples had been looked at before would be biased. Variance is
// told by halves, as that of the picture is; cost is counted in rays and vertices. So nothing depends on threads, clocks, the
// seed or the region that is rendered.
class Pilot {
public:
  // Fewer planned samples are not worth it.
  static constexpr uint32_t kLeastPlanned = 16;

  // What is given must outlive it. background: what need not be looked at; it changes nothing but the time. threads: how many
  // will work.
  Pilot(const Scene &scene, const Camera &camera, const Background &background, const IntegratorSettings &settings,
        uint32_t threads);

  // Every thread calls it once, all at the same time; each returns when the way is found.
  void work(uint32_t thread);
  // Then.
  const Splits &splits() const { return best_; }

private:
  // A pixel that has noise.
  struct Pixel {
    uint32_t x, y;
    double level = 0.0; // mean luminances of all looks, summed
  };
  // What the pixels tell of a way.
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
  uint32_t looks_ = 0;          // that levels are sums of
  double darkest_ = 0.0;        // added to every level
  uint64_t cost_of_others_ = 0; // of pixels without noise, whichever way
  // Of what is looked at now.
  Splits tried_;
  std::vector<SampleAddress> addresses_;                 // [pixel][sample]
  std::vector<float> luminances_;                        // of each
  std::vector<std::unique_ptr<Integrator>> integrators_; // by thread
  std::vector<uint64_t> costs_;                          // of each
  std::atomic<size_t> next_batch_{0};
  Splits best_;
  std::atomic<bool> done_{false};
  std::barrier<> barrier_;
};

} // namespace lancer
