#include "integrator/stages/occlusion.h"

#include "integrator/stages/terminator.h"

#include <limits>

namespace lancer {

const OcclusionKernel &occlusion_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(occlusion_kernel); }

OcclusionStage::OcclusionStage(const Scene &scene, const IntegratorSettings &settings)
    : kernel_(occlusion_kernel()), scene_(scene), reach_(normalised_reach(double(settings.occlusion_distance), scene)),
      next_rays_look_(!(scene.features & (kFeatureTransparency | kFeatureVisibility))) {}

OcclusionStage::OcclusionStage(const Scene &scene, float distance)
    : kernel_(occlusion_kernel()), scene_(scene), reach_(normalised_reach(double(distance), scene)), next_rays_look_(false) {}

// Like a shadow ray, the occlusion ray starts on the curved surface of a smooth mesh.
Ray OcclusionStage::ray_towards(const glm::vec3 &wi, uint32_t lane, const SurfaceStage &surfaces) const {
  LightSample around;
  around.wi = glm::dvec3(wi);
  around.distance = std::numeric_limits<double>::infinity();
  Ray ray = shadow_ray(scene_.geometry, surfaces.surface(lane), get(surfaces.lobes().ns, lane), get(surfaces.lobes().ng, lane),
                       around);
  ray.tmax = reach_;
  return ray;
}

OcclusionStage::Open OcclusionStage::send(uint32_t lane, const SurfaceStage &surfaces, const ScatterBlock &next,
                                          uint32_t sample, const glm::vec3 &weight, uint32_t passed,
                                          const LightPath<float> &path, ShadowStage &shadows) const {
  const Surface surface = surfaces.surface(lane);
  const glm::vec3 ns = get(surfaces.lobes().ns, lane), ng = get(surfaces.lobes().ng, lane);
  const auto push = [&](const glm::vec3 &wi, const glm::vec3 &share) {
    shadows.push(ray_towards(wi, lane, surfaces), {.target = sample, .occlusion = true}, share, passed);
    if (shadows.asks_light_path())
      shadows.set_light_path(path);
  };
  Open open;
  if (around_.by_itself >> lane & 1)
    push(get(around_.wi, lane), weight);
  else
    open.share[0] = weight;
  if (!(around_.by_next >> lane & 1))
    return open;
  const glm::vec3 wi = get(next.wi, lane);
  const float occlusion = around_.weight[lane];
  if (next.sampled >> lane & 1 && terminator_offset(scene_.geometry, surface, ns, ng, wi) == glm::dvec3(0.0)) {
    open.by_next = occlusion;
    return open;
  }
  // A next ray without weight is not traced, and a next ray near the terminator starts elsewhere. Both need an occlusion ray.
  open.share[1] = -glm::vec3(occlusion);
  push(wi, glm::vec3(occlusion));
  return open;
}

} // namespace lancer
