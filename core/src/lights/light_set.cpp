#include "lights/light_set.h"

#include "lights/area_light.h"

#include <algorithm>
#include <set>

namespace lancer {

namespace {

// Up to this number of lights with a position, the choice is that of Cycles. Among more lights, Cycles' choice would cost more
// per light and leave more noise.
constexpr size_t kFew = 4;

} // namespace

LightSet::LightSet(std::vector<Light> lights, std::vector<Emitter> emitters, size_t instance_count, Environment environment,
                   const BuildContext &context)
    : lamps_(std::move(lights)), emitters_(std::move(emitters)), environment_(std::move(environment)) {
  for (const Light &light : lamps_) {
    most_before_ = std::max(most_before_, kMostTolerances * light.plane_tolerance);
    switches_.push_back(light.hidden_from | (light.no_shadow ? kNoShadow : 0));
  }
  for (const Emitter &emitter : emitters_)
    switches_.push_back(emitter.hidden_from());
  if (environment_.is_light())
    switches_.push_back(environment_.hidden_from());
  std::vector<DescribedLight> described;
  described.reserve(size());
  for (uint32_t i = 0; i < lamps_.size(); ++i)
    described.push_back(describe(lamps_[i], i));
  for (const Emitter &emitter : emitters_)
    described.push_back(describe_cluster(emitter.bounds(), uint32_t(described.size())));
  // An environment that is visible to the camera alone lights no surface.
  if (environment_.is_light() && lit_by(environment_.hidden_from()))
    described.push_back(describe_sky(environment_.mean(), environment_light()));
  // Rays hit only lights that can be chosen: both techniques of multiple importance sampling must cover the same lights.
  std::vector<uint32_t> met;
  for (uint32_t i = 0; i < lamps_.size(); ++i)
    if (described[i].met && described[i].bounds.energy > 0.0)
      (described[i].distant() ? always_ : met).push_back(i);
  // Few lights are tested one by one.
  find_ = met.size() > kFew;
  if (!find_)
    always_.insert(always_.end(), met.begin(), met.end());
  const uint32_t count = uint32_t(size());
  std::vector<DescribedLight> near;
  std::copy_if(described.begin(), described.end(), std::back_inserter(near),
               [](const DescribedLight &light) { return !light.distant() && light.bounds.energy > 0.0; });
  if (near.size() > kFew) {
    std::erase_if(described, [](const DescribedLight &light) { return !light.distant(); });
    wide_tree_ = LightTree(std::move(near), count, context);
    described.push_back(describe_cluster(wide_tree_.bounds(), count));
  }
  binary_tree_ = BinaryLightTree(std::move(described), count + 1);
  if (!emitters_.empty()) {
    emitter_of_.assign(instance_count, kNone);
    for (uint32_t i = 0; i < emitters_.size(); ++i)
      emitter_of_[emitters_[i].instance()] = i;
  }
}

double LightSet::probability(const LightQuery &query, uint32_t light) const {
  const double of_many = wide_tree_.empty() ? 0.0 : wide_tree_.probability(query, light);
  return of_many > 0.0 ? of_many * binary_tree_.probability(query, uint32_t(size())) : binary_tree_.probability(query, light);
}

double LightSet::probability(const GeometryView &geometry, const LightQuery &query, const Emitter &emitter, float time,
                             uint32_t face) const {
  const double of_face = emitter.face_probability(geometry, query, time, face);
  return of_face > 0.0 ? of_face * probability(query, uint32_t(lamps_.size() + (&emitter - emitters_.data()))) : 0.0;
}

size_t LightSet::bytes() const {
  size_t bytes = environment_.bytes() + lamps_.size() * sizeof(Light) +
                 (emitter_of_.size() + switches_.size()) * sizeof(uint32_t) + binary_tree_.bytes() + wide_tree_.bytes();
  std::set<const EmissiveFaces *> counted;
  for (const Emitter &emitter : emitters_) {
    bytes += sizeof(Emitter);
    if (emitter.faces() && counted.insert(emitter.faces().get()).second)
      bytes += emitter.faces()->bytes();
  }
  return bytes;
}

} // namespace lancer
