// The choice of tiles to sample next: those where further samples lower the error of the picture most.
#pragma once

#include "render/picture_error.h"

namespace lancer {

// The tiles of a film in halves whose samples should be doubled next, those first whose doubling brings the error down most for
// its cost: as many as the target needs, or all where target is 0. The film must have been sampled in powers of two.
//
// What a half needs is judged by its other half alone. A decision that looked at its own samples would keep those that happen
// to be dark and add to those that happen to be bright, and the picture would come out too dark (Kirk, Arvo, "Unbiased sampling
// techniques for image synthesis", 1991); the other half's samples know nothing of them.
//   target: of the error of the picture; most: samples that no pixel may exceed.
struct Refinement {
  std::vector<uint32_t> tiles; // of this round, in order
  double samples = 0.0;        // pixel samples that the target needs in all from here on, as far as this can be foretold
};
Refinement plan_refinement(const Film &film, const LuminanceMap &map, const RelativeVariance &relative, double target,
                           uint32_t most);

} // namespace lancer
