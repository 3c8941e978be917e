// Ambient occlusion of vertices: the share of the hemisphere from which nothing near hides the surface.
//
// In: lobes, their means, next directions and numbers, from the integrator. Out: rays, for the shadow stage; open shares, for
// the film. Distances are in the normalised world. Caller: PATH.
#pragma once

#include "integrator/stages/scatter.h"
#include "integrator/stages/shadow.h"

#include <limits>

namespace lancer {

struct alignas(64) OcclusionBlock {
  Floats wi[3];           // sampled by the cosine around the mean normal of the diffuse lobes
  Floats weight;          // of an occluded next ray: the cosine's density over that of the ray's direction
  uint32_t by_next = 0;   // bits of lanes: the next ray replaces an occlusion ray
  uint32_t by_itself = 0; // bits of lanes: a ray towards wi is needed
};

struct OcclusionKernel {
  // asked: bits of lanes. next_rays_look: whether next rays meet the same surfaces as occlusion rays.
  void (*look)(const LobeBlock &lobes, const MeanBlock &means, const ScatterBlock &next, const VertexNumbers &numbers,
               uint32_t asked, bool next_rays_look, OcclusionBlock &around);
};
LANCER_DECLARE_KERNEL(OcclusionKernel, occlusion_kernel)

// Returns a length in the user's units in the normalised world, where 0 is unlimited.
inline double normalised_reach(double length, const Scene &scene) {
  return length > 0.0 ? length * scene.normalisation.scale : std::numeric_limits<double>::infinity();
}

class OcclusionStage {
public:
  OcclusionStage(const Scene &scene, const IntegratorSettings &settings);
  // distance: of occluders, in the user's units; each lane gets a ray of its own.
  OcclusionStage(const Scene &scene, float distance);

  // Samples a direction for each of the lanes that ask.
  void look(uint32_t asked, const SurfaceStage &surfaces, const ScatterBlock &next, const VertexNumbers &numbers) {
    if (asked != 0)
      kernel_.look(surfaces.lobes(), surfaces.means(), next, numbers, asked, next_rays_look_, around_);
  }
  // The open share of a vertex that is known at once, in two terms, and the weight that the next ray takes from it if a surface
  // occludes that ray.
  struct Open {
    glm::vec3 share[2] = {glm::vec3(0.0f), glm::vec3(0.0f)};
    float by_next = 0.0f;
  };
  // Queues the occlusion rays of a lane. weight: throughput of the lane; passed: surfaces that its path has passed; path: its
  // Light Path.
  Open send(uint32_t lane, const SurfaceStage &surfaces, const ScatterBlock &next, uint32_t sample, const glm::vec3 &weight,
            uint32_t passed, const LightPath<float> &path, ShadowStage &shadows) const;
  // Returns the occlusion ray of a lane.
  Ray ray(uint32_t lane, const SurfaceStage &surfaces) const { return ray_towards(get(around_.wi, lane), lane, surfaces); }
  // Whether a ray that replaces an occlusion ray is occluded.
  bool occluded(const Ray &ray, const Hit &hit) const { return hit.valid() && hit.t * glm::length(ray.d) < reach_; }

private:
  Ray ray_towards(const glm::vec3 &wi, uint32_t lane, const SurfaceStage &surfaces) const;

  const OcclusionKernel &kernel_;
  const Scene &scene_;
  double reach_;
  bool next_rays_look_;
  OcclusionBlock around_{};
};

} // namespace lancer
