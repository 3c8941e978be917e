#include "integrator/stages/numbers.h"

#include <algorithm>

namespace lancer {

const NumberKernel &number_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(number_kernel); }

void NumberStage::draw(uint32_t wanted, uint32_t count, uint32_t splitting, uint32_t branches, uint32_t branch) {
  digits_.dimension = dimension_[0];
  const uint32_t joint = std::min(uint32_t{kVertexStride}, kJointDimensions - std::min(digits_.dimension, kJointDimensions));
  uint32_t last = 0, points[kVertexStride] = {};
  for (uint32_t lane = 0; lane < count; ++lane) {
    const uint32_t sample = splitting >> lane & 1 ? sample_[lane] * branches + branch : sample_[lane];
    if (!same_) {
      const auto u = Sampler(digits_.pixel[lane], sample).get8(dimension_[lane]);
      for (uint32_t i = 0; i < kVertexStride; ++i)
        if (wanted >> i & 1)
          numbers.of[i][lane] = u[i];
      continue;
    }
    // Neighbours mostly have the same sample number, and so the same digits.
    if (lane == 0 || sample != last)
      for (uint32_t i = 0; i < joint; ++i)
        points[i] = sobol::reversed_point(sample, digits_.dimension + i);
    last = sample;
    digits_.reversed_sample[lane] = sobol::reverse_bits(sample);
    for (uint32_t i = 0; i < joint; ++i)
      digits_.reversed_point[i][lane] = points[i];
  }
  if (same_)
    kernel_.draw(digits_, wanted, count, numbers);
}

} // namespace lancer
