// Random walks below surfaces: from the entry of a path into a medium to the place where the path leaves it again, on the same
// instance.
//
// In: walks, with their entry, medium, throughput and sample, from PATH. Out: for each walk the hit from inside and the new
// throughput, or none if the path is lost. Lengths are in the normalised world. Caller: PATH.
#pragma once

#include "compile/scene.h"
#include "integrator/stages/hit.h"
#include "scene/lobe_inputs.h"
#include "simd/block.h"
#include "simd/processor.h"

#include <span>
#include <vector>

namespace lancer {

// A walk: its entry, and where it ends.
struct Walk {
  // In. The ray from the entry into the object; of Burley's profile, its origin alone.
  Ray ray;
  glm::vec3 n{0.0f};    // normal of the entry, against the walk, unit
  glm::vec3 beta{0.0f}; // throughput, with the colour of the surface; out: throughput at the end
  glm::vec3 color{0.0f}, radius{0.0f};
  float g = 0.0f;
  SubsurfaceMethod method = SubsurfaceMethod::RandomWalk;
  // The number that chooses the channel to walk for, and that of the first distance: evenly spread over the samples of a pixel.
  float u_channel = 0.0f, u_distance = 0.0f;
  uint32_t key = 0; // of its other numbers
  uint32_t instance = kNone;
  bool inside = false; // the walk is on the outer side of the surface
  // Out. The hit on the ray that ends the walk, from outside.
  Hit hit;
};

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
  // In of begin(): of the surface, and the numbers of a walk.
  Floats beta[3], color[3], radius[3], u_channel, u_distance;
  Words method;
  // Of the current step.
  Floats t, reach;                                   // distance to travel; how far to look for a surface
  Floats forward, backward, stretch, backward_share; // factors of the guided densities, see walk_kernel.cpp
  // Of its ray: distance to the surface, infinite if it meets none.
  Doubles met;
  // Out of advance(), in lanes that have left.
  Floats throughput[3];
  // Bits of lanes.
  uint32_t walking = 0; // in: lanes with a walk; out of advance(): those that go on
  uint32_t left = 0;    // out of advance(): lanes whose walk has reached the surface
};

struct WalkKernel {
  // Begins the walks of these lanes.
  void (*begin)(WalkBlock &block, uint32_t lanes);
  // Samples direction and distance of the next step of all walking lanes.
  void (*step)(WalkBlock &block);
  // Moves all walking lanes to the end of their step.
  void (*advance)(WalkBlock &block);
};
LANCER_DECLARE_KERNEL(WalkKernel, walk_kernel)

class WalkStage final : HitFilter {
public:
  explicit WalkStage(const Scene &scene);

  // Walks all of them to their ends; a walk without an end has an invalid hit. Returns the number of rays.
  uint64_t walk(std::span<Walk> walks);

private:
  bool counts(size_t ray, const Hit &hit) override;
  void load(const Walk &walk, size_t number, uint32_t lane);
  void fill(std::span<const Walk> walks, size_t &next);
  void close_ranks();
  void look(std::span<const Walk> walks);
  void end(Walk &walk, const WalkBlock &block, uint32_t lane, const Hit &hit, const Ray &ray);
  uint64_t leave_by_profile(std::span<Walk> walks);

  const Scene &scene_;
  const WalkKernel &kernel_;
  std::vector<uint8_t> all_instances_; // every instance asks
  std::vector<WalkBlock> blocks_;
  std::vector<size_t> walk_of_; // by block and lane
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<uint32_t> lane_of_, instance_of_; // of rays
  // Of Burley's profile: all hits of the rays.
  std::vector<std::vector<Hit>> crossed_;
  std::vector<uint8_t> occluded_;
  bool collects_ = false;
};

} // namespace lancer
