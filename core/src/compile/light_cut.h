// Cuts of a set of lights in two, for the builders of both light trees.
#pragma once

#include "lights/light_bounds.h"

#include <limits>
#include <vector>

namespace lancer {

// The place at which a set of lights is cut in two.
struct LightCut {
  int axis = -1; // -1: no cut costs less than the whole; the order stays
  uint32_t middle = 0;
  double cost = std::numeric_limits<double>::infinity();
};

LightBounds bounds_of(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end);
// Returns the cut of the lowest cost by the surface area orientation heuristic. cost: of the whole; a cut must cost less.
LightCut find_cut(const std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, double cost);
// Moves the lights before the cut to the front.
void make_cut(std::vector<DescribedLight> &lights, uint32_t begin, uint32_t end, const LightCut &cut);

// Drops lights without energy and divides all energies by the power of two next to the brightest, so that choices are the same
// at any scale. Returns the bounds of all lights, with their original energy.
LightBounds prepare(std::vector<DescribedLight> &lights);

} // namespace lancer
