// The light found by the last bounces of a batch, from which the light beyond the limit on bounces is estimated.
#pragma once

#include "integrator/sample.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lancer {

class LastBounces {
public:
  explicit LastBounces(uint32_t max_bounces) : max_bounces_(max_bounces) {}

  void begin() {
    slots_.clear();
    stage_ = 0;
    before_[0] = before_[1] = 0.0;
  }
  // Whether note() must be called in this turn of the queues. Each transparent surface delays a path by one turn. The path's
  // light then counts as that of a later bounce, so the estimate is too large rather than too small.
  bool due(uint32_t turn) const { return turn + 1 >= max_bounces_ && stage_ < 2; }
  // Stores the sum of the light gathered so far. Must be called after the light of this turn's hits is added. slot(i): returns
  // the slot of the sample of path i, one of count; shared: several paths may have the same sample; light(slot): returns the
  // light that the sample has gathered.
  template <class Slot, class Light> void note(uint32_t turn, size_t count, bool shared, Slot &&slot, Light &&light) {
    if (stage_ == 0)
      for (size_t i = 0; i < count; ++i)
        slots_.push_back(slot(i));
    if (stage_ == 0 && shared) {
      std::sort(slots_.begin(), slots_.end());
      slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
    }
    // With max_bounces of 0, only the light before the last bounce is noted at first.
    stage_ = turn + 1 == max_bounces_ ? 1 : 2;
    before_[stage_ - 1] = sum(light);
  }
  template <class Light> void end(Light &&light, Energy &energy) const {
    if (stage_ == 0)
      return;
    const double all = sum(light);
    energy.before_last += (stage_ == 2 ? before_[1] : all) - before_[0];
    energy.last += stage_ == 2 ? all - before_[1] : 0.0;
  }

private:
  // Skips samples that are not finite, because the film drops them.
  template <class Light> double sum(Light &&light) const {
    double result = 0.0;
    for (const uint32_t slot : slots_) {
      const float level = luminance(light(slot));
      result += std::isfinite(level) ? double(level) : 0.0;
    }
    return result;
  }

  uint32_t max_bounces_, stage_ = 0;
  double before_[2] = {};
  std::vector<uint32_t> slots_; // of the unfinished paths
};

} // namespace lancer
