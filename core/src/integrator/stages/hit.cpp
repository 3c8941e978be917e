#include "integrator/stages/hit.h"

#include <algorithm>

namespace lancer {

HitStage::HitStage(const Scene &scene, const Camera &camera, bool passes)
    : HitFilter(scene.perforated_instances.data()), scene_(scene), shader_(scene, &camera), crossings_(scene.geometry),
      passes_(passes && (scene.features & kFeatureTransparency) &&
              std::ranges::find(scene.perforated_instances, 1) != scene.perforated_instances.end()) {}

void HitStage::find(std::span<const Ray> rays, std::span<const uint32_t> left, std::vector<Hit> &hits) {
  hits.resize(rays.size());
  if (!passes_)
    return scene_.accelerator->closest_hit(rays, hits);
  left_ = left;
  crossings_.begin(rays.size());
  scene_.accelerator->closest_hit(rays, hits, *this);
}

bool HitStage::counts(size_t ray, const Hit &hit) {
  const uint32_t material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
  if (!scene_.cutouts[material].may_end)
    return true;
  Crossing *known = crossings_.find(ray, hit);
  if (known && known->hit.primitive == hit.primitive)
    return false;
  // Surfaces behind as many layers as the path may still pass are out of reach.
  if (!known && crossings_.count_before(ray, hit) >= left_[ray])
    return true;
  if (shader_.is_there(material, hit))
    return true;
  crossings_.put(known, ray, hit, glm::vec3(1.0f));
  return false;
}

} // namespace lancer
