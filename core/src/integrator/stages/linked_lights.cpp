#include "integrator/stages/linked_lights.h"

#include "lights/sample_light.h"

#include <algorithm>
#include <cmath>

namespace lancer {

LinkedLights::LinkedLights(const Scene &scene, const Camera &camera)
    : HitFilter(nullptr), scene_(scene), nodes_(scene, &camera), emission_(scene.node_scene(&camera), scene.materials),
      asked_(scene.geometry.instances.size(), 1) {
  instances = asked_.data();
  const LightSet &lights = scene.lights;
  for (uint32_t i = 0; i < lights.lamps().size(); ++i)
    if (lights.lamps()[i].links.clear_sets && has_extent(lights.lamps()[i]))
      lamps_.push_back(i);
  faces_pass_ = std::ranges::any_of(lights.emitters(), [](const Emitter &of) { return of.links().clear_sets != 0; });
}

void LinkedLights::begin(std::span<const Ray> rays, std::span<const Scattering> from) {
  rays_ = rays;
  from_ = from;
  met_.clear();
  faces_.clear();
  if (!faces_pass_)
    return;
  asking_rays_.clear();
  numbers_.clear();
  for (size_t i = 0; i < rays.size(); ++i)
    if (is_asked(i)) {
      asking_rays_.push_back(rays[i]);
      numbers_.push_back(i);
    }
  occluded_.assign(asking_rays_.size(), 0);
  scene_.accelerator->without_order().any_hit(asking_rays_, occluded_, *this);
  // A filter may be asked about a hit twice, and in any order.
  std::ranges::sort(faces_, [](const Found &a, const Found &b) {
    return a.ray != b.ray ? a.ray < b.ray : closer(a.hit.t, a.hit.instance, a.hit.primitive, b.hit);
  });
  // The faces of a common edge are one light.
  const auto again = std::ranges::unique(faces_, [](const Found &a, const Found &b) {
    return a.ray == b.ray && a.hit.t == b.hit.t && a.hit.instance == b.hit.instance;
  });
  faces_.erase(again.begin(), again.end());
}

bool LinkedLights::counts(size_t ray, const Hit &hit) {
  const Emitter *const emitter = scene_.lights.emitter_of(hit.instance);
  if (emitter && emitter->links().clear_sets && emitter->links().reaches(from_[numbers_[ray]].receiver_set))
    faces_.push_back({numbers_[ray], hit});
  return false;
}

LightHit LinkedLights::hit_of(size_t ray, uint32_t light) const {
  const Light &lamp = scene_.lights.lamps()[light];
  return lamp.links.reaches(from_[ray].receiver_set) ? meet(lamp, from_[ray].p, glm::normalize(rays_[ray].d)) : LightHit{};
}

void LinkedLights::add_lamp(size_t ray, uint32_t light, const LightHit &hit, const glm::vec3 &radiance) {
  const Scattering &from = from_[ray];
  const double pdf = from.pdf > 0.0 ? hit.pdf * scene_.lights.probability(from.query(), light) : 0.0;
  const float weight = from.pdf > 0.0 ? mis_weight(from.pdf, pdf) : 1.0f;
  const glm::dvec3 wi = glm::normalize(rays_[ray].d);
  met_.push_back({ray, radiance, weight, scene_.lights.hidden_from(light), scene_.lights.links(light),
                  scene_.lights.group_of(scene_.geometry, light),
                  std::isinf(hit.distance) ? glm::dvec3(hit.distance) : from.p + hit.distance * wi});
}

void LinkedLights::add_face(size_t ray, const Surface &surface, const glm::vec3 &radiance) {
  if (radiance == glm::vec3(0.0f))
    return;
  const Scattering &from = from_[ray];
  const Emitter &emitter = *scene_.lights.emitter_of(surface.instance);
  // End on the side that the ray sees, off the surface by the surface's own error bound.
  const glm::dvec3 ng(surface.ng);
  const double side = glm::dot(ng, rays_[ray].d) < 0.0 ? 1.0 : -1.0;
  met_.push_back({ray, radiance, emitter_weight(scene_, from, emitter, surface), emitter.hidden_from(), emitter.links(),
                  scene_.geometry.instances[surface.instance].light_group, surface.p + side * surface.offset * ng});
}

} // namespace lancer
