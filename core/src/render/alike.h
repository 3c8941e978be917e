// The neighbours of a pixel whose luminance does not differ from its own by more than noise explains.
#pragma once

#include "render/luminance_map.h"

namespace lancer {

// Over each pixel and those of the 7 x 7 around it that are like it, [height][width]: their number, the sum of their
// luminances, and that of the variances of one sample of theirs.
//
// Two pixels are alike where their luminances and those of the 3 x 3 around them differ by no more than noise explains, all
// nine together. Pixel by pixel the question fails where it matters: two replicates say so little about one pixel's variance
// that every tenth looks noisy enough to be like anything, the edge of a lit thing like the black beside it (Buades, Coll,
// Morel, "A non-local algorithm for image denoising", 2005, compare surroundings so).
struct AlikeNeighbours {
  std::vector<float> count, mean, variance;

  explicit AlikeNeighbours(const LuminanceMap &map);
};

} // namespace lancer
