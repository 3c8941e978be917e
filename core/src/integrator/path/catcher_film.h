// The light of shadow catchers that the camera sees. A path that meets one goes on as two: one among all objects, whose light
// is in the picture, and one among shadow catchers alone, whose light divides that of the other (Cycles' Shadow Catcher).
#pragma once

#include "integrator/extras.h"
#include "integrator/sample.h"

#include <span>
#include <vector>

namespace lancer {

class CatcherFilm {
public:
  explicit CatcherFilm(const ExtraLayout &layout) : layout_(layout) {}

  bool keeps() const { return layout_.catchers; }
  // Begins a batch. sums: of indirect light in each sample.
  void begin(size_t samples, uint32_t sums);
  // Takes the picture so far as the matte of a sample whose path meets a catcher. gathered: the light of the sample; share: of
  // the path.
  void meet(uint32_t sample, const SampleResult &result, const glm::vec3 &gathered, float share, Extras &extras);
  // Adds light among catchers alone. sum: number of the sum of indirect light among all of the batch.
  void add(uint32_t sample, uint32_t sum, const glm::vec3 &light, bool indirect, Extras &extras) {
    if (indirect)
      indirect_[sum] += light;
    else
      add(extras, sample, layout_.catcher_light(), light);
  }
  // Returns the sums of indirect light of a sample, for clamping.
  std::span<glm::vec3> indirect(uint32_t sample) { return std::span(indirect_).subspan(size_t(sample) * sums_, sums_); }
  // Adds the indirect light to that of the catchers, and completes the matte, which is the whole picture where no path has met
  // a catcher.
  void end(uint32_t sample, const SampleResult &result, Extras &extras);

private:
  void add(Extras &extras, uint32_t sample, uint32_t channel, const glm::vec3 &light) const;

  ExtraLayout layout_;
  uint32_t sums_ = 1;
  std::vector<uint8_t> met_;        // by sample
  std::vector<glm::vec3> indirect_; // as PathFilm's
};

} // namespace lancer
