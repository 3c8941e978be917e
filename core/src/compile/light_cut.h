// How a crowd of lights is cut in two, for both trees.
#pragma once

#include "lights/light_bounds.h"

#include <limits>
#include <vector>

namespace lancer {

// Where to cut a crowd of lights in two.
struct LightCut {
  int axis = -1; // none: nothing costs less than the whole; keep the order
  uint32_t middle = 0;
  double cost = std::numeric_limits<double>::infinity();
};

LightBounds bounds_of(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end);
// The cut that the surface area orientation heuristic likes best; cost: of the whole.
LightCut find_cut(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, double cost);
// Brings what lies before the cut to the front.
void make_cut(std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, const LightCut &cut);

// Drops lights without energy and makes energies relative to the brightest, by a power of two: the same choices at any scale.
// Returns the bounds of all, energy as it was.
LightBounds prepare(std::vector<DescribedLight> &lights);

} // namespace lancer
