// Lights that pass some blockers by their links, where rays from scatterings run into them: such a light is behind the surfaces
// that the ray hits, and a shadow ray of its own finds the blockers on the way.
//
// In: rays, the last scatterings of their paths and their Light Paths, from the integrator. Out: the lights on the way of each
// ray, whatever it hits, with their weight against light samples. The rays of one scattering find each light once: those that
// have passed a surface since find none. Caller: PATH, beside the stage of met lights, which leaves these lights out.
#pragma once

#include "integrator/stages/met_lights.h"

namespace lancer {

struct LinkedLight {
  size_t ray;
  glm::vec3 radiance;
  float weight;
  uint32_t hidden_from; // RayKind bits
  LightLinks links;
  uint32_t group;    // of the light; 0 = none
  glm::dvec3 target; // where the shadow ray ends
};

class LinkedLights final : HitFilter {
public:
  // The scene's lights must pass some blockers.
  LinkedLights(const Scene &scene, const Camera &camera);

  // Returns all such lights on the way of the rays, valid until the next call. asking(ray), path(ray, distance): return the
  // Light Path of a light sample at the last scattering, and that of the ray at a distance.
  template <class AskingOf, class PathOf>
  std::span<const LinkedLight> find(std::span<const Ray> rays, std::span<const Scattering> from, AskingOf &&asking,
                                    PathOf &&path) {
    begin(rays, from);
    for (size_t i = 0; i < rays.size(); ++i)
      for (size_t k = 0; k < lamps_.size() && is_asked(i); ++k)
        meet_lamp(i, lamps_[k], asking);
    for (const Found &found : faces_)
      meet_face(found.ray, found.hit, path);
    return met_;
  }

private:
  struct Found {
    size_t ray;
    Hit hit;
  };

  void begin(std::span<const Ray> rays, std::span<const Scattering> from);
  // Whether a ray is the first of a scattering.
  bool is_asked(size_t ray) const { return from_[ray].receiver_set != kNone && from_[ray].passed == 0.0; }
  // Collects the hits of emitters; a ray goes on behind each of its hits.
  bool counts(size_t ray, const Hit &hit) override;
  template <class AskingOf> void meet_lamp(size_t ray, uint32_t light, AskingOf &&asking) {
    const LightHit hit = hit_of(ray, light);
    if (!(hit.pdf > 0.0))
      return;
    const Light &lamp = scene_.lights.lamps()[light];
    const glm::dvec3 wi = glm::normalize(rays_[ray].d);
    glm::vec3 radiance = hit.radiance;
    const bool far = lamp.kind == LightKind::Sun;
    if (lamp.shader != kNone) {
      nodes_.set(0, lamp, far ? glm::dvec3(0.0) : from_[ray].p + hit.distance * wi, wi, far ? 0.0 : hit.distance, asking(ray));
      nodes_.look(1);
      radiance *= nodes_.strength(0);
    }
    add_lamp(ray, light, hit, radiance);
  }
  template <class PathOf> void meet_face(size_t ray, const Hit &hit, PathOf &&path) {
    const Surface surface = surface_at(scene_.geometry, scene_.slots, rays_[ray], hit);
    const double distance = (hit.t - rays_[ray].tmin) * glm::length(rays_[ray].d);
    add_face(ray, surface, emission_(surface, glm::vec3(-glm::normalize(rays_[ray].d)), path(ray, distance)));
  }
  // Returns pdf 0 where the light does not reach the scattering, or the ray misses.
  LightHit hit_of(size_t ray, uint32_t light) const;
  void add_lamp(size_t ray, uint32_t light, const LightHit &hit, const glm::vec3 &radiance);
  void add_face(size_t ray, const Surface &surface, const glm::vec3 &radiance);

  const Scene &scene_;
  LampStage nodes_;
  EmissionAt emission_;
  std::vector<uint32_t> lamps_; // that pass blockers and may be hit
  bool faces_pass_ = false;     // some emitter passes blockers
  std::vector<uint8_t> asked_;  // HitFilter::instances: all
  std::span<const Ray> rays_;
  std::span<const Scattering> from_;
  // The rays that ask for faces, by their own numbers and those of the batch.
  std::vector<Ray> asking_rays_;
  std::vector<size_t> numbers_;
  std::vector<uint8_t> occluded_;
  std::vector<Found> faces_;
  std::vector<LinkedLight> met_;
};

} // namespace lancer
