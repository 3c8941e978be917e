// How far each pixel may be from the converged picture.
#pragma once

#include "render/picture_error.h"

#include <vector>

namespace lancer {

// Standard error of each pixel's mean luminance: [height][width]; infinity where it is not known yet. Two replicates say little
// about one pixel, so their variance is shared over the smallest square window in which enough pixels bear it: where light is
// rare, and most pixels have seen none of it, the window grows until it holds the ones that have. Over pixels of all kinds 95 %
// of the true values then lie within 1.96 standard errors (Rousselle, Manzi, Zwicker, "Robust Denoising using Feature and Color
// Information", 2013, share variances so).
// The edge of a clean surface has noise that its flanks have not: pixels share with those of their kind alone. A pixel between
// a darker and a brighter neighbour is an edge where what a mixture of these two would vary by, at most (Bhatia, Davis, "A
// better bound on the variance", 2000), is more than all the noise around it; edges share with edges that would vary about as
// much.
std::vector<float> error_bars(const LuminanceMap &map);

} // namespace lancer
