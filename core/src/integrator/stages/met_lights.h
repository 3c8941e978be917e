// Light that rays run into: lamps on their way, surfaces that emit, the environment behind all surfaces.
//
// In: rays, their hits, and the last scatterings of their paths, from the integrator. Out: radiance of lamps and of a varying
// environment towards the last scattering, and the weight of all light, also of surfaces, by the power heuristic
// (lights/sample_light.h), because light sampling may have found the same light. Lengths are in the normalised world, densities
// per solid angle. Caller: PATH.
#pragma once

#include "integrator/stages/light.h"

namespace lancer {

// The last scattering of a path, written by the integrator: light samples from there compete with the path's ray. Of a camera
// ray: its origin; n is 0.
struct Scattering {
  glm::dvec3 p{0.0};
  glm::vec3 n{0.0f};             // shading normal
  bool transmits = false;        // some lobe scatters light to the other side
  double pdf = 0.0;              // ScatterBlock::pdf of the ray; 0 after the camera or a single direction
  double passed = 0.0;           // normalised distance to the ray's origin, through transparent surfaces
  uint32_t receiver_set = kNone; // of the surface; kNone: of the camera, which sees every light

  LightQuery query() const { return LightQuery(p, n, transmits, receiver_set); }
  // Whether the light of these links reaches the scattering along its ray, without a shadow ray that passes blockers.
  bool meets(const LightLinks &links) const {
    return receiver_set == kNone || (links.reaches(receiver_set) && links.clear_sets == 0);
  }
};

// Returns the weight of the light of an emitter's surface that a ray has hit, against light samples.
float emitter_weight(const Scene &scene, const Scattering &from, const Emitter &emitter, const Surface &surface);

// A lamp on the way of a ray.
struct MetLight {
  size_t ray;
  uint32_t light;
  glm::vec3 radiance;
  float weight;
  double distance; // as LightHit
};

class MetLights final : LightVisitor {
public:
  MetLights(const Scene &scene, const Camera &camera)
      : scene_(scene), kernel_(light_kernel()), sky_(scene, &camera), lamps_(scene, &camera) {}

  // Returns all lamps that the rays pass before they end, because lights occlude nothing; valid until the next call. path(ray):
  // returns the Light Path of a light sample at the last scattering, which nodes of lamps read.
  template <class PathOf>
  std::span<const MetLight> find(std::span<const Ray> rays, std::span<const Hit> hits, std::span<const Scattering> from,
                                 PathOf &&path) {
    find(rays, hits, from);
    if (!scene_.lamp_shaders.empty())
      shade(path);
    return met_;
  }
  // Returns the weight of the emission of a surface that a ray has hit; 0 where its light does not reach the last scattering.
  float emission_weight(const Scattering &from, const Surface &surface) const;

  // The environment in the directions of rays that hit nothing: add the rays lane by lane, look, then read the results. from:
  // the last scattering; path: Light Path of the ray; eye: where a camera ray begins, null for any other ray.
  void add_miss(uint32_t lane, const Scattering &from, const glm::dvec3 &d, LightPath<float> path, const glm::dvec3 *eye);
  void look_at_sky(uint32_t count);
  glm::vec3 sky_radiance(uint32_t lane) const { return sky_.radiance(lane); }
  float sky_weight(uint32_t lane, const Scattering &from) const;

private:
  void find(std::span<const Ray> rays, std::span<const Hit> hits, std::span<const Scattering> from);
  // Multiplies the radiance of met lamps by what their nodes say.
  template <class PathOf> void shade(PathOf &&path) {
    std::erase_if(met_, [](const MetLight &met) { return met.radiance == glm::vec3(0.0f); });
    for (size_t first = 0; first < met_.size(); first += kBlockLanes) {
      const auto now = std::span(met_).subspan(first, std::min<size_t>(kBlockLanes, met_.size() - first));
      uint32_t shaded = 0;
      for (uint32_t lane = 0; lane < now.size(); ++lane) {
        const MetLight &met = now[lane];
        const Light &lamp = scene_.lights.lamps()[met.light];
        if (lamp.shader == kNone)
          continue;
        shaded |= 1u << lane;
        const glm::dvec3 wi = glm::normalize(rays_[met.ray].d);
        const bool far = lamp.kind == LightKind::Sun;
        const glm::dvec3 target = far ? glm::dvec3(0.0) : from_[met.ray].p + met.distance * wi;
        lamps_.set(lane, lamp, target, wi, far ? 0.0 : met.distance - from_[met.ray].passed, path(met.ray));
      }
      lamps_.look(shaded);
      each_lane(shaded, [&](uint32_t lane) { now[lane].radiance *= lamps_.strength(lane); });
    }
  }
  // Meets a light of the tree of many lights with a ray of the block.
  void visit(uint32_t lane, uint32_t light) override { meet_alone(first_ + lane, light); }
  void meet_lamp(uint32_t lanes, uint32_t light);
  void meet_alone(size_t ray, uint32_t light);
  bool is_on_segment(size_t ray, const LightHit &hit) const;
  void add(size_t ray, uint32_t light, const LightHit &hit, double chosen);
  double end_of(size_t ray) const {
    return from_[ray].passed + std::min(hits_[ray].t, rays_[ray].tmax) * glm::length(rays_[ray].d);
  }

  const Scene &scene_;
  const LightKernel &kernel_;
  SkyStage sky_;
  LampStage lamps_;
  // The last batch: its rays, their hits and the vertices that they left.
  std::span<const Ray> rays_;
  std::span<const Hit> hits_;
  std::span<const Scattering> from_;
  std::vector<MetLight> met_;
  size_t first_ = 0; // ray of the block
  SegmentBlock segments_{};
  MetBlock block_{};
  SkyBlock misses_{};
  Doubles density_[2] = {}; // of the misses, by Scattering::transmits
};

} // namespace lancer
