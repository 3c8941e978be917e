// How far the whole picture may be from the converged one.
#pragma once

#include "render/luminance_map.h"

#include <limits>

namespace lancer {

// The error of a picture is the root mean square over its pixels of the standard error of their luminance, each relative to
// the pixel's luminance plus 1 % of the picture's mean.
struct PictureError {
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  double error = kUnknown;
  double low = kUnknown, high = kUnknown; // with the confidence asked for the truth lies between
  // Light that comes in flashes which no sample has met may be missing: at 95 %, no more than this, measured as error is.
  double cannot_exclude = kUnknown;
};

// What an error is made of, pixel by pixel.
struct RelativeVariance {
  // [height][width]: of one sample, over the square of luminance and floor. own: as the pixel's replicates have it; shared: as
  // those of the neighbours have it that are like it (alike.h).
  std::vector<float> own, shared;

  explicit RelativeVariance(const LuminanceMap &map);
};

// confidence: of the interval, in (0, 1). A pixel's own replicates understate where light is rare: the pixels that have missed
// it look both dark and sure. Neighbours' overstate, along edges. The interval reaches from what the first says to what the
// second says, widened at both ends by what chance may do to such sums.
PictureError picture_error(const LuminanceMap &map, const RelativeVariance &relative, double confidence);

} // namespace lancer
