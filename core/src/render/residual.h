// The share of a denoised picture's residual that is not noise, in each band of a pyramid.
#pragma once

#include "render/neighbourhood.h"

namespace lancer {

// The residual R, the noise H, and the part of the noise that the denoiser takes, H - G.
struct Level {
  Colors residual, noise, taken;
};

// Replaces residual and taken by their shares: in each band of a pyramid (Burt, Adelson, "The Laplacian pyramid as a compact
// image code", 1983), since a picture is more certain about large areas than about pixels. The error is least for the share 1 -
// <H, H - G> / <R, R> with sums over a neighbourhood, which is James' and Stein's shrinkage of the picture towards the denoised
// one. As the sums are uncertain, the share takes the upper end of the noise's interval, two standard deviations: a share that
// is too small costs less than one that is too large.
void keep_shares(Level &level);

} // namespace lancer
