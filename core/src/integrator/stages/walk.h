// Random walks below surfaces: from the entry of a path into a medium to the place where the path leaves it again, on the same
// instance.
//
// In: walks, with their entry, medium, throughput and sample, from PATH. Out: for each walk the hit from outside and the new
// throughput, or none if the path is lost. Lengths are in the normalised world. Caller: PATH.
#pragma once

#include "compile/scene.h"
#include "integrator/stages/profile.h"
#include "simd/block.h"
#include "simd/processor.h"

#include <span>
#include <vector>

namespace lancer {

// The walks of a block: their places, directions and media, and each step's part of their weights. A walk samples distances for
// one channel, its hero. light: the light of each channel over the hero's density of the steps so far, densities: the density
// of each channel over that of the hero, times its probability to be the hero; light over the sum of densities is the
// throughput (the balance heuristic over whole walks).
struct alignas(64) WalkBlock {
  // Kept from step to step.
  Doubles p[3];
  Floats d[3], n[3], depth;                 // of travel; normal of the entry, and the depth below its plane
  Floats sigma_t[3], sigma_s[3], g, guided; // of the medium; probability of a direction towards the surface
  Floats length, log_length;                // diffusion_length() with log((v + 1) / (v - 1))
  Floats opposite;                          // distance to the other side along -n, 0 if none is near
  Floats light[3], densities[3];
  Words hero, key, steps; // channel; steps taken
  Floats u_distance;      // number of the first distance
  // In of begin(): of the surface, and the number that chooses a channel.
  Floats beta[3], color[3], radius[3], ior, u_channel;
  Words method;
  // Members of the current step.
  Floats t, reach;                                   // distance to travel; how far to look for a surface
  Floats forward, backward, stretch, backward_share; // factors of the guided densities, see walk_kernel.cpp
  // Distance along its ray to the surface, infinite if it meets none.
  Doubles met;
  // Out of advance(), in lanes that have left.
  Floats throughput[3];
  // Bits of lanes.
  uint32_t walking = 0; // in: lanes with a walk; out of advance(): those that go on
  uint32_t left = 0;    // out of advance(): lanes whose walk has reached the surface
};

struct WalkKernel {
  // Begins the walks of the lanes of `walking`.
  void (*begin)(WalkBlock &block);
  // Samples direction and distance of the next step of all walking lanes.
  void (*step)(WalkBlock &block);
  // Moves all walking lanes to the end of their step.
  void (*advance)(WalkBlock &block);
};
LANCER_DECLARE_KERNEL(WalkKernel, walk_kernel)

class WalkStage {
public:
  explicit WalkStage(const Scene &scene);

  // Walks all of them to their ends; a walk without an end has an invalid hit. Returns the number of rays.
  uint64_t walk(std::span<Walk> walks);

private:
  void load(const Walk &walk, uint32_t lane);
  void begin_some(std::span<const Walk> walks);
  void fill(std::span<const Walk> walks);
  void close_ranks();
  void look(std::span<const Walk> walks);

  const WalkKernel &kernel_;
  OwnHits own_;
  ProfileStage profile_;
  // Numbers of the walks: by their profile, and at random.
  std::vector<size_t> by_profile_, at_random_;
  size_t next_ = 0; // of at_random_: the next walk to begin
  // Walks that have begun and wait for a lane, from its lane first_waiting_ on: their media are found with all lanes in use.
  WalkBlock waiting_{};
  uint32_t first_waiting_ = 0;
  size_t waiting_walks_[kBlockLanes];
  std::vector<WalkBlock> blocks_;
  std::vector<size_t> walk_of_; // by block and lane
  // By ray.
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<uint32_t> lane_of_, instance_of_;
};

} // namespace lancer
