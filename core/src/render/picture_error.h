// The error of a picture, estimated from the differences of its halves; the interval that is told of it, and what more samples
// would bring.
#pragma once

#include "render/film.h"

#include <limits>
#include <vector>

namespace lancer {

// What the film knows of the light of its pixels, laid out as a picture.

// Luminances are in units of the picture's mean, and bounded, so that no square of them leaves the range of floats.
struct LuminanceMap {
  uint32_t width = 0, height = 0;
  bool known = true; // false: some pixel has too few samples to tell an error from
  double unit = 1.0; // mean luminance of the picture, what is negative counted as dark; 1 where all is dark
  // [height][width]; variance: of one sample, such that that of the mean is variance / count.
  std::vector<float> mean, variance, brightest, count;

  explicit LuminanceMap(const Film &film);

  size_t size() const { return mean.size(); }
  // What is added wherever something is divided by luminance, so that black pixels do not decide alone: 1 % of the mean.
  float floor() const { return dark ? 0.0f : 0.01f; }
  bool dark = false;
};

// The neighbours of a pixel whose luminance does not differ from its own by more than noise explains.

// Over each pixel and those of the 7 x 7 around it that are like it, [height][width]: their number, the sum of their
// luminances, and that of the variances of one sample of theirs.
//
// Two pixels are alike where their luminances and those of the 3 x 3 around them differ by no more than noise explains, all
// nine together. Pixel by pixel the question fails where it matters: two halves say so little about one pixel's variance
// that every tenth looks noisy enough to be like anything, the edge of a lit thing like the black beside it (Buades, Coll,
// Morel, "A non-local algorithm for image denoising", 2005, compare surroundings so).
struct SimilarNeighbours {
  std::vector<float> count, mean, variance;

  explicit SimilarNeighbours(const LuminanceMap &map);
};

// How far the whole picture may be from the converged one.

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
  // [height][width]: of one sample, over the square of luminance and floor. own: as the pixel's halves have it; shared: as
  // those of the neighbours have it that are like it (similar.h).
  std::vector<float> own, shared;

  explicit RelativeVariance(const LuminanceMap &map);
};

// confidence: of the interval, in (0, 1). A pixel's own halves understate where light is rare: the pixels that have missed
// it look both dark and sure. Neighbours' overstate, along edges. The interval reaches from what the first says to what the
// second says, widened at both ends by what chance may do to such sums. Its lower end also allows for variance that falls as
// N^-2, where halves tell three times what there is: edges alone fall as N^-1.5, light mostly as N^-1 (film.h).
PictureError picture_error(const LuminanceMap &map, const RelativeVariance &relative, double confidence);

// How far each pixel may be from the converged picture.

// Standard error of each pixel's mean luminance: [height][width]; infinity where it is not known yet. Two halves say little
// about one pixel, so their variance is shared over the smallest square window in which enough pixels bear it: where light is
// rare, and most pixels have seen none of it, the window grows until it holds the ones that have. Over pixels of all kinds 95 %
// of the true values then lie within 1.96 standard errors (Rousselle, Manzi, Zwicker, "Robust Denoising using Feature and Color
// Information", 2013, share variances so).
// The edge of a clean surface has noise that its flanks have not: pixels share with those of their kind alone. A pixel between
// a darker and a brighter neighbour is an edge where what a mixture of these two would vary by, at most (Bhatia, Davis, "A
// better bound on the variance", 2000), is more than all the noise around it; edges share with edges that would vary about as
// much.
std::vector<float> error_bars(const LuminanceMap &map);

// The choice of tiles to sample next: those where further samples lower the error of the picture most.

// The tiles of a film in halves whose samples should be doubled next, those first whose doubling brings the error down most for
// its cost: as many as the target needs, or all where target is 0. The film must have been sampled in powers of two.
//
// What a half needs is judged by its other half. A decision that looked at its own samples would keep those that happen to be
// dark and add to those that happen to be bright, and the picture would come out too dark (Kirk, Arvo, "Unbiased sampling
// techniques for image synthesis", 1991). Some of that is left where light comes in rare flashes: the variance that the other
// half shares also has neighbours in this one, and rounds go on until the told error of the whole is small, which drowns the
// flashes that have been met. Judged by the other half's pixels alone, one flash in the half that it does not see costs up to
// ten times the samples. Blocks of 16 x 16 were measured too dark by up to 2.6 % of the target.
//   target: of the error of the picture; most: samples that no pixel may exceed.
struct Refinement {
  std::vector<uint32_t> tiles; // of this round, in order
  double samples = 0.0;        // pixel samples that the target needs in all from here on, as far as this can be foretold
};
Refinement plan_refinement(const Film &film, const LuminanceMap &map, const RelativeVariance &relative, double target,
                           uint32_t most);

} // namespace lancer
