// What vertices side by side ask of lights, and the shadow rays that follow.
#include "integrator/lane_access.h"
#include "integrator/path_kinds.h"

#include <cmath>

namespace lancer {

// Seen from the viewer's side, as the light comes.
template <uint32_t Shapes, bool Layers> LightQuery PathIntegrator<Shapes, Layers>::query(uint32_t lane) const {
  const glm::vec3 ns = get(block_.ns, lane);
  const bool behind = glm::dot(get(block_.wo, lane), get(block_.ng, lane)) < 0.0f;
  return LightQuery(get(block_.p, lane), behind ? -ns : ns, block_.transmits >> lane & 1);
}

template <uint32_t Shapes, bool Layers> LightSet::Choice PathIntegrator<Shapes, Layers>::choose_light(uint32_t lane) const {
  const LightChoice few{block_.chosen[lane], block_.chosen_probability[lane], block_.chosen_rest[lane]};
  if (!(few.probability > 0.0) || scene_.lights.decided(few.number))
    return {few.number, 0, few.probability};
  return scene_.lights.choose_within(scene_.geometry, query(lane), few);
}

// Goes on with the lanes that have chosen the cluster of all lights with a place.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::choose_of_many() {
  if (scene_.lights.many().empty())
    return;
  LightWalk walks[kBlockLanes];
  uint32_t lanes[kBlockLanes], count = 0;
  for (uint32_t lane = 0; lane < waiting_count_; ++lane)
    if (block_.chosen[lane] == scene_.lights.size() && block_.chosen_probability[lane] > 0.0 && !waiting_[lane].ends) {
      walks[count] = LightTree::walk(query(lane), block_.chosen_rest[lane]);
      lanes[count++] = lane;
    }
  scene_.lights.many().choose({walks, count});
  for (uint32_t i = 0; i < count; ++i) {
    block_.chosen[lanes[i]] = walks[i].number;
    block_.chosen_probability[lanes[i]] *= walks[i].probability;
    block_.chosen_rest[lanes[i]] = walks[i].u;
  }
}

// Chooses a light for every lane; samples those that kernels do not know.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::ask_lights() {
  static const Light nothing;
  block_.asked = 0;
  uint32_t skies = 0;
  const FewLights &few = scene_.lights.few();
  if (!few.empty()) {
    block_.light_nodes = few.nodes();
    lanes_.choose(block_);
    choose_of_many();
  }
  for (uint32_t lane = 0; lane < kBlockLanes; ++lane) {
    block_.lamp[lane] = &nothing;
    block_.light_pdf[lane] = 0.0;
    block_.light_delta[lane] = block_.light_hidden[lane] = 0;
    if (lane >= waiting_count_ || waiting_[lane].ends || few.empty() || !block_.material[lane]->smooth)
      continue;
    const LightSet::Choice choice = choose_light(lane);
    if (!(choice.probability > 0.0))
      continue;
    waiting_[lane].light = choice.light;
    block_.light_hidden[lane] = scene_.lights.hidden_from(choice.light);
    if (choice.light < scene_.lights.lights().size()) {
      const Light &lamp = scene_.lights.lights()[choice.light];
      block_.lamp[lane] = &lamp;
      waiting_[lane].far = lamp.kind == LightKind::Sun;
      block_.light_pdf[lane] = choice.probability;
      block_.asked |= 1u << lane;
      continue;
    }
    if (choice.light == scene_.lights.environment_light()) {
      block_.light_pdf[lane] = choice.probability;
      skies |= 1u << lane;
      continue;
    }
    const LightSample light = sample_scene_light(scene_, choice, get(block_.p, lane),
                                                 {block_.u[kVertexLight][lane], block_.u[kVertexLight + 1][lane]}, shader_);
    if (!(light.pdf > 0.0) || light.radiance == glm::vec3(0.0f))
      continue;
    waiting_[lane].far = std::isinf(light.distance);
    put(light.wi, block_.light_wi, lane);
    put(light.target, block_.light_target, lane);
    put(light.radiance, block_.light_radiance, lane);
    block_.light_pdf[lane] = light.pdf * choice.probability;
    block_.light_delta[lane] = light.delta;
  }
  ask_sky(skies);
}

template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::send_shadow_of(uint32_t lane) {
  const Waiting &waiting = waiting_[lane];
  const Path &path = paths_[waiting.number];
  const glm::vec3 contribution = get(block_.contribution, lane);
  if (scene_.lights.no_shadow(waiting.light))
    return shadows_.push_lit({.slot = path.slot, .indirect = path.scatterings > 0}, contribution);
  const double infinity = std::numeric_limits<double>::infinity();
  Ray &ray = shadows_.push(path.slot, contribution, path.scatterings > 0, path.passed_through);
  if (block_.lifted >> lane & 1) {
    LightSample sample;
    sample.wi = get(block_.light_wi, lane);
    sample.target = get(block_.light_target, lane);
    sample.distance = waiting.far ? infinity : 1.0;
    ray = shadow_ray(scene_.geometry, surface_of(lane), get(block_.viewer_ns, lane), get(block_.viewer_ng, lane), sample);
  } else {
    const glm::dvec3 o = get(block_.shadow_origin, lane);
    const glm::dvec3 d = waiting.far ? get(block_.light_wi, lane) : get(block_.light_target, lane) - o;
    leave(hits_[waiting.number], o, d, waiting.far ? infinity : 1.0, LANCER_RAY_SHADOW, ray);
  }
}

#define LANCER_PATH(shapes, layers)                                                                                            \
  template void PathIntegrator<shapes, layers>::ask_lights();                                                                  \
  template void PathIntegrator<shapes, layers>::send_shadow_of(uint32_t);
LANCER_PATH_KINDS(LANCER_PATH)
#undef LANCER_PATH

} // namespace lancer
