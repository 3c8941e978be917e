// Choosing of many lights and finding those on a ray's way in vector registers, one copy per instruction set; all give the same
// bits.
#pragma once

#include "accel/kernel_choice.h"
#include "lights/light_branch.h"
#include "lights/way_block.h"
#include "sampling/direction_table.h"

namespace lancer {

struct LightKernel {
  const char *name;
  // A light for each: u is the number to choose by, then what is left of it.
  void (*choose)(const LightBranches &tree, LightWalk *walks, uint32_t count);
  // With which choose() comes to the child in that slot; number, u, probability of the walk are not read.
  double (*probability)(const LightBranches &tree, const LightWalk &walk, uint32_t slot);
  // Calls visit(context, lane, light) for all that the first count ways may meet; no other light is met.
  using Visit = void (*)(void *context, uint32_t lane, uint32_t light);
  void (*along)(const LightBranches &tree, const WayBlock &ways, uint32_t count, Visit visit, void *context);
  // Samples directions of the environment from the numbers u; asks for the density of those given.
  void (*sample_sky)(const DirectionTable &map, SkyBlock &block);
  void (*sky_density)(const DirectionTable &map, SkyBlock &block);
};

// Each is the same source, light_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(LightKernel, light_kernel)

} // namespace lancer
