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
  // In. The ray from the entry into the object; of Burley's profile, to the outside of the surface.
  Ray ray;
  glm::vec3 n{0.0f};    // normal of the entry, against the walk, unit
  glm::vec3 beta{0.0f}; // throughput, with the colour of the surface; out: throughput at the end
  glm::vec3 color{0.0f}, radius{0.0f};
  float g = 0.0f;
  SubsurfaceMethod method = SubsurfaceMethod::RandomWalk;
  uint32_t pixel = 0, sample = 0, dimension = 0; // address of its numbers
  uint32_t instance = kNone;
  bool inside = false; // the walk is on the outer side of the surface
  // Out. The hit on the ray that ends the walk, from outside.
  Hit hit;
};

// The walks of a block: their places, directions, media and numbers, and what a step has found out for its own weight.
struct alignas(64) WalkBlock {
  Doubles p[3], begin[3];                // the place of a walk, and of its entry
  Floats d[3], n[3];                     // of travel; outward normal of the entry
  Floats sigma_t[3], albedo[3], beta[3]; // of the medium; throughput
  Floats g, length, log_length;          // mean cosine; diffusion_length() with log((v + 1) / (v - 1))
  Floats opposite;                       // distance to the other side along -n, 0 if none is near
  Words pixel, sample, dimension, steps; // steps taken
  // In of medium(): of the surface.
  Floats color[3], radius[3];
  Words method;
  // Of the current step.
  Doubles t, reach;                                  // distance to travel; how far to look for a surface
  Floats channel[3];                                 // probability of each channel
  Floats forward, backward, stretch, backward_share; // factors of the guided densities, see walk_kernel.cpp
  // Of its ray: distance to the surface, infinite if it meets none.
  Doubles met;
  // Bits of lanes.
  uint32_t walking = 0; // in: lanes with a walk; out of advance(): those that go on
  uint32_t left = 0;    // out of advance(): lanes whose walk has reached the surface
};

struct WalkKernel {
  // Sets the medium of these lanes from color, radius, g and method.
  void (*medium)(WalkBlock &block, uint32_t lanes);
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
  void load(Walk &walk, size_t number, WalkBlock &block, uint32_t lane);
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
