// Sums of mattes: for each pixel of a tile the ids that samples have met, with the sums of their shares.
//
// Two sums are joined id by id, so each id of a pixel is summed along the tree of the film. A pixel keeps LANCER_MOST_MATTES
// ids in every sum: those with the largest shares, and among equal ones some that differ from subtree to subtree, so that no id
// is left out of all. The sum of a subtree depends on its samples and its place alone, like all sums of the film.
#pragma once

#include "integrator/extras.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lancer {

// The mattes of samples that follow one another, by sample.
class MattesBySample {
public:
  MattesBySample(std::span<const MatteShare> mattes, size_t samples);
  std::span<const MatteShare> of(size_t sample) const {
    return std::span(sorted_).subspan(ends_[sample], ends_[sample + 1] - ends_[sample]);
  }

private:
  std::vector<uint32_t> ends_; // of the sample before, by sample
  std::vector<MatteShare> sorted_;
};

struct MatteSums {
  std::vector<uint32_t> ends; // by pixel: number of mattes up to its end
  std::vector<uint32_t> ids;  // rising within a pixel
  std::vector<double> shares;

  // Sets the sums to those of one sample of each pixel, of which the first has this number.
  void gather(const MattesBySample &mattes, uint32_t kind, size_t first, uint32_t pixels);
  // Adds the earlier half of a subtree. key: a number of the subtree.
  void join(const MatteSums &earlier, uint32_t key);
  // Appends the mattes of a pixel; returns the number appended.
  uint32_t append(const MatteSums &from, uint32_t pixel);
  uint32_t begin(uint32_t pixel) const { return pixel == 0 ? 0 : ends[pixel - 1]; }
  size_t bytes() const { return (ends.capacity() + ids.capacity()) * sizeof(uint32_t) + shares.capacity() * sizeof(double); }

private:
  void limit(size_t begin, uint32_t key);
};

} // namespace lancer
