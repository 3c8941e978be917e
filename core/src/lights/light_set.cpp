#include "lights/light_set.h"

#include "lights/area_light.h"

#include <algorithm>
#include <set>

namespace lancer {

namespace {

// Up to this number of lights with a position, the choice is that of Cycles. Among more lights, Cycles' choice would cost more
// per light and leave more noise.
constexpr size_t kFew = 4;

// Makes the trees of lights among all_count lights.
LightTrees make_trees(std::vector<DescribedLight> described, uint32_t all_count, const BuildContext &context) {
  LightTrees trees;
  std::vector<DescribedLight> near;
  std::copy_if(described.begin(), described.end(), std::back_inserter(near),
               [](const DescribedLight &light) { return !light.distant() && light.bounds.energy > 0.0; });
  if (near.size() > kFew) {
    std::erase_if(described, [](const DescribedLight &light) { return !light.distant(); });
    trees.many = LightTree(std::move(near), all_count, context);
    described.push_back(describe_cluster(trees.many.bounds(), all_count));
  }
  trees.few = BinaryLightTree(std::move(described), all_count + 1);
  return trees;
}

} // namespace

double LightTrees::probability(const LightQuery &query, uint32_t light, uint32_t number_of_many) const {
  const double of_many = many.empty() ? 0.0 : many.probability(query, light);
  return of_many > 0.0 ? of_many * few.probability(query, number_of_many) : few.probability(query, light);
}

LightSet::LightSet(std::vector<Light> lights, std::vector<Emitter> emitters, size_t instance_count, Environment environment,
                   const BuildContext &context, uint64_t receiver_sets, std::vector<Light> openings)
    : lamps_(std::move(lights)), emitters_(std::move(emitters)), environment_(std::move(environment)),
      openings_(std::move(openings)) {
  for (const Light &light : lamps_) {
    most_before_ = std::max(most_before_, kMostTolerances * light.plane_tolerance);
    switches_.push_back(light.hidden_from | (light.no_shadow ? kNoShadow : 0));
  }
  for (const Emitter &emitter : emitters_)
    switches_.push_back(emitter.hidden_from());
  if (environment_.is_light())
    switches_.push_back(environment_.hidden_from());
  for (const Light &light : lamps_)
    lit_surfaces_.push_back(light.lit_surfaces);
  lit_surfaces_.resize(size(), 0);
  if (environment_.is_light())
    lit_surfaces_.back() = environment_.lit_surfaces();
  if (std::ranges::all_of(lit_surfaces_, [](uint32_t lit) { return lit == 0; }))
    lit_surfaces_.clear();
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
  link(described, receiver_sets, context);
  trees_ = make_trees(std::move(described), uint32_t(size()), context);
  if (!emitters_.empty()) {
    emitter_of_.assign(instance_count, kNone);
    for (uint32_t i = 0; i < emitters_.size(); ++i)
      emitter_of_[emitters_[i].instance()] = i;
  }
}

// Keeps the links of all lights, and makes the trees of the sets of receivers that some light does not reach.
void LightSet::link(const std::vector<DescribedLight> &described, uint64_t receiver_sets, const BuildContext &context) {
  std::vector<LightLinks> links(size());
  for (size_t i = 0; i < lamps_.size(); ++i)
    links[i] = lamps_[i].links;
  for (size_t i = 0; i < emitters_.size(); ++i)
    links[lamps_.size() + i] = emitters_[i].links();
  uint64_t unlit = 0;
  for (const LightLinks &of : links) {
    unlit |= of.unlit_sets & receiver_sets;
    passes_blockers_ = passes_blockers_ || of.clear_sets != 0;
  }
  if (unlit == 0 && !passes_blockers_)
    return;
  links_ = std::move(links);
  if (unlit == 0)
    return;
  // All sets that every light reaches share the first trees.
  trees_of_.assign(kLinkSets, 0);
  linked_trees_.push_back(make_trees(described, uint32_t(size()), context));
  for (uint32_t set = 0; set < kLinkSets; ++set) {
    if (!(unlit >> set & 1))
      continue;
    std::vector<DescribedLight> reaching;
    std::ranges::copy_if(described, std::back_inserter(reaching),
                         [&](const DescribedLight &light) { return links_[light.light.number].reaches(set); });
    trees_of_[set] = uint8_t(linked_trees_.size());
    linked_trees_.push_back(make_trees(std::move(reaching), uint32_t(size()), context));
  }
}

double LightSet::probability(const LightQuery &query, uint32_t light) const {
  return trees(query.receiver_set).probability(query, light, uint32_t(size()));
}

double LightSet::probability(const GeometryView &geometry, const LightQuery &query, const Emitter &emitter, float time,
                             uint32_t face) const {
  const double of_face = emitter.face_probability(geometry, query, time, face);
  return of_face > 0.0 ? of_face * probability(query, uint32_t(lamps_.size() + (&emitter - emitters_.data()))) : 0.0;
}

size_t LightSet::bytes() const {
  size_t bytes = environment_.bytes() + (lamps_.size() + openings_.size()) * sizeof(Light) +
                 (emitter_of_.size() + switches_.size()) * sizeof(uint32_t) + trees_.few.bytes() + trees_.many.bytes() +
                 links_.size() * sizeof(LightLinks);
  for (const LightTrees &trees : linked_trees_)
    bytes += trees.few.bytes() + trees.many.bytes();
  std::set<const EmissiveFaces *> counted;
  for (const Emitter &emitter : emitters_) {
    bytes += sizeof(Emitter);
    if (emitter.faces() && counted.insert(emitter.faces().get()).second)
      bytes += emitter.faces()->bytes();
  }
  return bytes;
}

} // namespace lancer
