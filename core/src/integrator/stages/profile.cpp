#include "integrator/stages/profile.h"

#include "bsdf/subsurface.h"
#include "sampling/sobol.h"

#include <algorithm>

namespace lancer {

namespace {

// Probes at a time: enough for batches of rays, few enough that their hits on a surface of many layers fit in the cache.
constexpr size_t kProbes = 64;

} // namespace

uint64_t ProfileStage::leave(std::span<Walk> walks, std::span<const size_t> numbers) {
  for (size_t first = 0; first < numbers.size(); first += kProbes) {
    const auto now = numbers.subspan(first, std::min(kProbes, numbers.size() - first));
    probes_.clear();
    rays_.clear();
    instance_of_.clear();
    for (const size_t number : now)
      send(walks[number]);
    own_.all(rays_, instance_of_);
    for (size_t i = 0; i < now.size(); ++i)
      choose(walks[now[i]], i);
  }
  return numbers.size();
}

void ProfileStage::send(const Walk &walk) {
  const glm::vec3 radii = walking_radius(walk.method, walk.radius, walk.color, walk.ior);
  // Choose one of the channels that have a radius, and a distance by its profile.
  float channels = 0.0f;
  for (int i = 0; i < 3; ++i)
    channels += radii[i] > 0.0f ? 1.0f : 0.0f;
  float u = walk.u_channel * channels, radius = 0.0f;
  for (int i = 0; i < 3; ++i)
    if (radii[i] > 0.0f) {
      radius = radii[i];
      if (u < 1.0f)
        break;
      u -= 1.0f;
    }
  const Frame<float> at(walk.n);
  const AxisProbe axes(glm::dvec3(at.n), glm::dvec3(at.t), glm::dvec3(at.b), walk.u_distance);
  const Probe &probe = probes_.emplace_back(axes, radii, burley_radius(std::min(u, 1.0f)) * radius);
  Ray &ray = rays_.emplace_back();
  axes.place(walk.ray.o, double(probe.r), double(kBurleyReach) * double(radius), ray.o, ray.d, ray.tmax);
  ray.time = walk.ray.time;
  instance_of_.push_back(walk.instance);
}

// Returns the light that leaves at a surface over the densities of all axes and channels.
glm::vec3 ProfileStage::weight(const Walk &walk, const Probe &probe, const Surface &surface) const {
  const auto r = float(glm::length(surface.p - walk.ray.o));
  float density = 0.0f, channels = 0.0f;
  glm::vec3 profile(0.0f);
  for (int k = 0; k < 3; ++k)
    if (probe.radius[k] > 0.0f) {
      profile[k] = burley_profile(probe.radius[k], r);
      density += burley_profile(probe.radius[k], probe.r);
      channels += 1.0f;
    }
  const auto seen = float(probe.axes.weight(glm::dvec3(surface.ng)));
  return density > 0.0f ? profile * (seen * channels / density) : glm::vec3(0.0f);
}

// Ends a walk at one of the surfaces that its probe has met. number: of the probe.
void ProfileStage::choose(Walk &walk, size_t number) {
  const std::span<const Hit> hits = own_.hits_of(number);
  surfaces_.clear();
  weights_.clear();
  float sum = 0.0f;
  for (const Hit &hit : hits) {
    surfaces_.push_back(surface_at(scene_.geometry, scene_.slots, rays_[number], hit));
    weights_.push_back(weight(walk, probes_[number], surfaces_.back()));
    sum += mean(weights_.back());
  }
  // Choose one by its weight; rounding may leave a number beyond the last: the last one that has a weight is chosen then.
  float left = float(hash_combine(walk.key, 0) >> 8) * 0x1p-24f * sum;
  size_t chosen = hits.size();
  for (size_t k = 0; k < hits.size() && left >= 0.0f; ++k)
    if (const float share = mean(weights_[k]); share > 0.0f) {
      chosen = k;
      left -= share;
    }
  if (chosen == hits.size())
    return;
  walk.beta *= weights_[chosen] * (sum / mean(weights_[chosen]));
  // See the place along its normal, from as far as the entry, on the side on which the path has met the surface.
  const Surface &surface = surfaces_[chosen];
  const glm::dvec3 n(walk.from_behind ? -surface.ng : surface.ng);
  walk.hit = hits[chosen];
  walk.hit.t = glm::length(surface.p - walk.ray.o);
  walk.ray = rays_[number];
  walk.ray.o = surface.p + walk.hit.t * n;
  walk.ray.d = -n;
}

} // namespace lancer
