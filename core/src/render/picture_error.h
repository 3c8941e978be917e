// The error of a picture, estimated from the differences of its halves, its interval, and the samples that reduce it most.
#pragma once

#include "render/film.h"

#include <limits>
#include <vector>

namespace lancer {

// The film's statistics of luminance, laid out as a picture.

// Luminances are in units of the picture's mean, and bounded, so that no square of them leaves the range of floats.
struct LuminanceMap {
  uint32_t width = 0, height = 0;
  bool known = true; // false: some pixel has too few samples to estimate an error
  double unit = 1.0; // mean absolute luminance of the picture's pixels; 1 where the picture is black
  // [height][width]; variance: of one sample; the variance of the mean is variance / count.
  std::vector<float> mean, variance, brightest, count;

  // threads: the most that read the film.
  explicit LuminanceMap(const Film &film, uint32_t threads = 1);

  size_t size() const { return mean.size(); }
  // Added to each luminance that is a divisor, so that black pixels do not dominate: 1 % of the mean.
  float floor() const { return dark ? 0.0f : 0.01f; }
  bool dark = false;
};

// The similar neighbours of a pixel: those whose luminances differ from the pixel's by no more than noise explains.

// [height][width], over each pixel and the similar pixels of the 7 x 7 around it: their number, the sum of their luminances,
// and the sum of the variances of one sample of each.
//
// Two pixels are similar if the luminances of the 3 x 3 pixels around each, taken together, differ by no more than noise
// explains. A test of single pixels would fail: two halves estimate one pixel's variance so poorly that every tenth pixel looks
// noisy enough to be similar to any other. The edge of a lit object would then be similar to the black beside it. Buades, Coll,
// Morel, "A non-local algorithm for image denoising", 2005, compare neighbourhoods in the same way.
struct SimilarNeighbours {
  std::vector<float> count, mean, variance;

  explicit SimilarNeighbours(const LuminanceMap &map, uint32_t threads = 1);
};

// The error of a whole picture.

// The error is the root mean square over the pixels of the standard error of their luminance, each relative to the pixel's
// luminance plus 1 % of the picture's mean.
struct PictureError {
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  double error = kUnknown;
  double low = kUnknown, high = kUnknown; // bounds of the interval with the requested confidence
  // Bound of the light that may be missing because it comes in rare flashes that no sample has hit: at 95 % confidence, in the
  // unit of error.
  double cannot_exclude = kUnknown;
};

// Returns z such that a Gaussian number lies within +- z with this probability.
double gaussian_reach(double confidence);

// The contribution of each pixel to the error.
struct RelativeVariance {
  // [height][width]: variance of one sample, over the square of luminance plus floor. own: from the pixel's own halves; shared:
  // the mean over the similar neighbours.
  std::vector<float> own, shared;

  explicit RelativeVariance(const LuminanceMap &map, uint32_t threads = 1);
};

// confidence: of the interval, in (0, 1). A pixel's own halves underestimate the error where light is rare: pixels that have
// missed the light look both dark and certain. The neighbours' halves overestimate the error along edges. The interval reaches
// from the first estimate to the second, widened at both ends by the spread of such sums. Its lower end also allows for a
// variance that falls as N^-2, where halves report three times the variance (film.h): the variance of edges alone falls as
// N^-1.5, that of light mostly as N^-1.
PictureError picture_error(const LuminanceMap &map, const RelativeVariance &relative, double confidence);

// The error of each pixel.

// Returns the standard error of each pixel's mean luminance: [height][width]; infinity where a pixel has no samples.
//
// Two halves estimate the variance of one pixel poorly, so the variance is averaged over a square window: the smallest in which
// enough pixels have variance. Where light is rare and most pixels have none, the window grows until it contains lit pixels.
// Over pixels of all kinds, 95 % of the true values then lie within 1.96 standard errors (Rousselle, Manzi, Zwicker, "Robust
// Denoising using Feature and Color Information", 2013, average variances in the same way).
//
// The edge of a clean surface has noise that the pixels beside the edge lack. So edges share variances with edges alone, and
// other pixels with other pixels. A pixel between a darker and a brighter neighbour is an edge if the largest variance of a
// mixture of these two (Bhatia, Davis, "A better bound on the variance", 2000) exceeds all the noise around the pixel. Edges
// share only with edges of about the same mixture variance.
std::vector<float> error_bars(const LuminanceMap &map);

// The choice of the tiles to sample next: the tiles whose further samples lower the error of the picture most.

// The tiles of a film in halves whose samples should be doubled next. Tiles are sorted by the decrease of the error per added
// sample; there are as many as the target needs, or all if target is 0. Each tile's number of samples must be a power of two.
//
// The other half decides whether a half is refined. If a half's own samples decided, samples that happen to be dark would be
// kept and samples that happen to be bright would be diluted, so the picture would be too dark (Kirk, Arvo, "Unbiased sampling
// techniques for image synthesis", 1991). Some of this bias remains where light comes in rare flashes. First, the other half
// shares variances with its neighbours, some of which are pixels of this half. Second, refinement continues until the estimated
// error of the whole picture is small, which dilutes the flashes that have been hit. Sharing within the other half alone would
// take up to ten times the samples after one flash in this half. Blocks of 16 x 16 were measured too dark by up to 2.6 % of the
// target.
//   target: of the error of the picture; most: samples that no pixel may exceed.
struct Refinement {
  std::vector<uint32_t> tiles; // of this round, in order
  double samples = 0.0;        // predicted number of further pixel samples until the target is met
};
Refinement plan_refinement(const Film &film, const LuminanceMap &map, const RelativeVariance &relative, double target,
                           uint32_t most);

} // namespace lancer
