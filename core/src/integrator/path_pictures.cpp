// What paths see of pictures: the environment, where they end or ask for its light, and colours on surfaces.
#include "integrator/lane_access.h"
#include "integrator/mis_weight.h"
#include "integrator/path_kinds.h"
#include "sampling/color.h"
#include "scene/attribute.h"
#include "scene/flat_picture.h"

#include <bit>

namespace lancer {

template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::miss(size_t number, std::span<SampleResult> results) {
  Path &path = paths_[number];
  SampleResult &result = results[path.slot];
  if (path.in_view && !picture_alone_ && !records_[path.slot].seen)
    forget_place(result);
  if (path.scatterings == 0)
    add_sky_features(records_[path.slot].features, result);
  // A transparent film does not show the environment itself, only what it lights.
  if (path.in_view && settings_.film_transparent) {
    result.alpha -= mean(path.beta);
    return;
  }
  if (!(path.kinds & ~scene_.world.hidden_from))
    return;
  const Environment &environment = scene_.lights.environment();
  if (!environment.varies()) {
    add(path, result, path.beta * environment.constant(), true);
    return;
  }
  const glm::dvec3 wi = glm::normalize(rays_[number].d);
  if (picture_alone_) {
    put(wi, misses_.wi, missed_count_);
    missed_[missed_count_++] = number;
    if (missed_count_ == kBlockLanes)
      add_missed(results);
    return;
  }
  add_environment(path, path.pdf > 0.0 ? environment.pdf(wi) : 0.0, environment_towards(path, wi), result);
}

template <uint32_t Shapes, bool Layers>
glm::vec3 PathIntegrator<Shapes, Layers>::environment_towards(const Path &path, const glm::dvec3 &wi) {
  const glm::dvec3 *eye = path.kinds == LANCER_RAY_CAMERA ? &path.from : nullptr;
  LightPath<float> seen_by = light_path(path, 0.0);
  seen_by.length = std::numeric_limits<float>::max();
  // What lies beyond everything counts as one scattering more, as in Cycles.
  seen_by.depth += 1.0f;
  return scene_.lights.environment().radiance(wi, shader_.values(), &camera_, eye, seen_by);
}

// The environment is sampled as a light, too. pdf: of its sample.
template <uint32_t Shapes, bool Layers>
void PathIntegrator<Shapes, Layers>::add_environment(const Path &path, double pdf, const glm::vec3 &radiance,
                                                     SampleResult &result) {
  float weight = 1.0f;
  if (path.pdf > 0.0)
    weight = mis_weight(path.pdf, pdf * scene_.lights.probability(query(path), scene_.lights.environment_light()));
  add(path, result, path.beta * radiance * weight, true);
}

// What waits beside others that have met nothing.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::add_missed(std::span<SampleResult> results) {
  if (missed_count_ == 0)
    return;
  picture_lanes_.look_at_sky(misses_, sky_);
  for (uint32_t lane = 0; lane < missed_count_; ++lane) {
    const Path &path = paths_[missed_[lane]];
    const glm::vec3 radiance =
        sky_.image.texels ? get(misses_.radiance, lane) : environment_towards(path, get(misses_.wi, lane));
    add_environment(path, misses_.pdf[lane], radiance, results[path.slot]);
  }
  missed_count_ = 0;
}

// Samples of the environment, for lanes that have chosen it.
template <uint32_t Shapes, bool Layers> void PathIntegrator<Shapes, Layers>::ask_sky(uint32_t lanes) {
  if (lanes == 0)
    return;
  picture_lanes_.sample_sky(block_, sky_, lanes);
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    waiting_[lane].far = true;
    if (sky_.image.texels)
      continue;
    const glm::vec3 radiance =
        scene_.lights.environment().radiance(get(block_.light_wi, lane), shader_.values(), &camera_, nullptr);
    put(radiance, block_.light_radiance, lane);
    if (radiance == glm::vec3(0.0f))
      block_.light_pdf[lane] = 0.0;
  }
}

// Colours of those lanes whose materials have a picture; tells which.
template <uint32_t Shapes, bool Layers> uint32_t PathIntegrator<Shapes, Layers>::ask_pictures() {
  const ColorPicture *pictures[kBlockLanes];
  uint32_t lanes = 0;
  for (uint32_t lane = 0; lane < waiting_count_; ++lane) {
    if (!block_.material[lane]->nodes || !(block_.on_mesh >> lane & 1))
      continue;
    const Hit &hit = hits_[waiting_[lane].number];
    pictures[lane] = &scene_.pictures[material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive)];
    if (!pictures[lane]->image)
      continue;
    const Mesh &mesh = scene_.geometry.meshes[scene_.geometry.instances[hit.instance].mesh];
    const glm::vec2 uv = uv_at(mesh, pictures[lane]->uv_map, hit.primitive, {hit.u, hit.v});
    colors_.uv[0][lane] = uv.x;
    colors_.uv[1][lane] = uv.y;
    lanes |= 1u << lane;
  }
  // All lanes of one picture together.
  for (uint32_t rest = lanes; rest != 0;) {
    const ColorPicture *picture = pictures[std::countr_zero(rest)];
    uint32_t same = 0;
    for (uint32_t of = rest; of != 0; of &= of - 1)
      if (pictures[std::countr_zero(of)] == picture)
        same |= of & -of;
    picture_lanes_.look_up(colors_, picture->wide, same);
    rest &= ~same;
  }
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    const ColorPicture &picture = *pictures[lane];
    const float alpha = clamped_alpha(colors_.alpha[lane], picture.clamped);
    const glm::vec3 color = in_range(get(colors_.color, lane));
    const glm::vec3 weight = picture.covers ? in_range(glm::vec3(alpha)) : picture.weight;
    put(weight, block_.weight, lane);
    put(picture.weighted ? weight * color : color, block_.base, lane);
    if (picture.clears) {
      waiting_[lane].transmittance = glm::vec3(std::max(picture.whole - alpha, 0.0f));
      block_.through[lane] = mean(waiting_[lane].transmittance);
    }
  }
  return lanes;
}

#define LANCER_PATH(shapes, layers)                                                                                            \
  template void PathIntegrator<shapes, layers>::miss(size_t, std::span<SampleResult>);                                         \
  template void PathIntegrator<shapes, layers>::add_missed(std::span<SampleResult>);                                           \
  template void PathIntegrator<shapes, layers>::ask_sky(uint32_t);                                                             \
  template uint32_t PathIntegrator<shapes, layers>::ask_pictures();
LANCER_PATH_KINDS(LANCER_PATH)
#undef LANCER_PATH

} // namespace lancer
