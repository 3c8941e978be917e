#include "integrator/stages/light.h"

#include <algorithm>
#include <cmath>

namespace lancer {

const LightKernel &light_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(light_kernel); }

namespace {

LightQuery query_of(const SurfaceBlock &surfaces, const LobeBlock &lobes, uint32_t lane) {
  return LightQuery(get(surfaces.p, lane), get(lobes.ns, lane), lobes.transmits >> lane & 1);
}

} // namespace

LightStage::LightStage(const Scene &scene, const Camera *camera)
    : scene_(scene), kernel_(light_kernel()), emission_(scene.node_scene(camera), scene.materials), sky_(scene, camera),
      lamp_nodes_(scene, camera), has_lamp_shaders_(!scene.lamp_shaders.empty()),
      placed_(scene.features & kFeatureMotion ? kBlockLanes : 0) {}

// Clears the samples of all lanes.
void LightStage::begin() {
  static const Light nothing;
  lamps_ = emitters_ = skies_ = samples_.far = 0;
  for (uint32_t lane = 0; lane < kBlockLanes; ++lane) {
    lamp_[lane] = &nothing;
    samples_.pdf[lane] = samples_.weighed[lane] = 0.0;
    samples_.delta[lane] = samples_.hidden[lane] = 0;
  }
}

void LightStage::choose(uint32_t asking, const SurfaceBlock &surfaces, const LobeBlock &lobes, const VertexNumbers &numbers) {
  begin();
  const LightSet &lights = scene_.lights;
  if (lights.binary_tree().empty())
    return;
  asking &= lobes.scatters & lobes.used;
  if (lights.linked()) {
    choose_by_sets(asking, surfaces, lobes, numbers);
  } else {
    kernel_.choose(surfaces, lobes, numbers, lights.binary_tree().nodes(), choices_);
    choose_of_many(asking, lights.wide_tree(), surfaces, lobes);
  }
  each_lane(asking, [&](uint32_t lane) {
    const uint32_t light = choices_.number[lane];
    if (!(choices_.probability[lane] > 0.0))
      return;
    samples_.hidden[lane] = lights.hidden_from(light);
    if (light < lights.lamps().size()) {
      lamp_[lane] = &lights.lamps()[light];
      samples_.far |= uint32_t(lamp_[lane]->kind == LightKind::Sun) << lane;
      lamps_ |= 1u << lane;
    } else {
      (light == lights.environment_light() ? skies_ : emitters_) |= 1u << lane;
    }
  });
  for (int i = 0; i < 2; ++i)
    std::copy_n(numbers.of[kVertexLight + i], kBlockLanes, faces_.u[i]);
  choose_faces(surfaces, lobes);
}

// Lets the lanes of each set of receivers choose among the lights that reach it.
void LightStage::choose_by_sets(uint32_t asking, const SurfaceBlock &surfaces, const LobeBlock &lobes,
                                const VertexNumbers &numbers) {
  std::fill_n(choices_.probability, kBlockLanes, 0.0);
  for (uint32_t rest = asking; rest != 0;) {
    const uint32_t set = receiver_set_[std::countr_zero(rest)];
    uint32_t lanes = 0;
    each_lane(rest, [&](uint32_t lane) { lanes |= uint32_t(receiver_set_[lane] == set) << lane; });
    rest &= ~lanes;
    const LightTrees &trees = scene_.lights.trees(set);
    if (trees.few.empty())
      continue;
    kernel_.choose(surfaces, lobes, numbers, trees.few.nodes(), of_set_);
    each_lane(lanes, [&](uint32_t lane) {
      choices_.number[lane] = of_set_.number[lane];
      choices_.probability[lane] = of_set_.probability[lane];
      choices_.rest[lane] = of_set_.rest[lane];
    });
    choose_of_many(lanes, trees.many, surfaces, lobes);
  }
}

// Continues the choice in the lanes that have chosen the cluster of all lights with a position.
void LightStage::choose_of_many(uint32_t asking, const LightTree &many, const SurfaceBlock &surfaces, const LobeBlock &lobes) {
  if (many.empty())
    return;
  LightWalk walks[kBlockLanes];
  uint32_t lanes[kBlockLanes], count = 0;
  each_lane(asking, [&](uint32_t lane) {
    if (choices_.number[lane] != scene_.lights.size() || !(choices_.probability[lane] > 0.0))
      return;
    walks[count] = LightTree::walk(query_of(surfaces, lobes, lane), choices_.rest[lane]);
    lanes[count++] = lane;
  });
  many.choose({walks, count});
  for (uint32_t i = 0; i < count; ++i) {
    choices_.number[lanes[i]] = walks[i].number;
    choices_.probability[lanes[i]] *= walks[i].probability;
    choices_.rest[lanes[i]] = walks[i].u;
  }
}

// Continues the choice in the lanes that have chosen an emitter; lanes with the same emitter choose together. Lanes without a
// face of positive probability choose no emitter.
void LightStage::choose_faces(const SurfaceBlock &surfaces, const LobeBlock &lobes) {
  for (uint32_t lanes = emitters_; lanes != 0;) {
    const uint32_t light = choices_.number[std::countr_zero(lanes)];
    LightWalk walks[kBlockLanes];
    uint32_t of[kBlockLanes] = {}, count = 0;
    for (uint32_t rest = lanes; rest != 0; rest &= rest - 1)
      if (const uint32_t lane = uint32_t(std::countr_zero(rest)); choices_.number[lane] == light)
        of[count++] = lane;
    const Emitter &emitter = emitter_of(of[0]);
    if (emitter.faces()) {
      for (uint32_t i = 0; i < count; ++i)
        walks[i] = emitter.faces()->walk(placed(of[i]), query_of(surfaces, lobes, of[i]), choices_.rest[of[i]]);
      emitter.faces()->choose({walks, count});
    }
    for (uint32_t i = 0; i < count; ++i) {
      face_[of[i]] = emitter.faces() ? walks[i].number : 0;
      if (emitter.faces())
        choices_.probability[of[i]] *= walks[i].probability;
      lanes &= ~(1u << of[i]);
      if (!(choices_.probability[of[i]] > 0.0))
        emitters_ &= ~(1u << of[i]);
    }
  }
}

void LightStage::sample(uint32_t light, uint32_t lanes, const Doubles (&p)[3], const Floats &time,
                        const VertexNumbers &numbers) {
  time_ = time;
  begin();
  const LightSet &lights = scene_.lights;
  std::fill_n(choices_.number, kBlockLanes, light);
  std::fill_n(choices_.probability, kBlockLanes, 1.0);
  std::fill_n(samples_.hidden, kBlockLanes, lights.hidden_from(light));
  if (light < lights.lamps().size()) {
    const Light &lamp = lights.lamps()[light];
    samples_.far = lamp.kind == LightKind::Sun ? lanes : 0;
    kernel_.sample_lamp(lamp, p, numbers, lanes, samples_);
    if (lamp.shader != kNone) {
      lamps_ = lanes;
      std::fill_n(lamp_, kBlockLanes, &lamp);
      shade_lamps([](uint32_t) { return LightPath<float>{}; });
    }
    return;
  }
  if (light == lights.environment_light()) {
    skies_ = lanes;
    for (uint32_t rest = lanes; rest != 0; rest &= rest - 1)
      sky_.set_path(uint32_t(std::countr_zero(rest)), {}, nullptr);
    return sample_sky(p, numbers, 0);
  }
  // Choose the faces by power; the rest of the random number places the point on the face.
  emitters_ = lanes;
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    if (const auto &faces = emitter_of(lane).faces()) {
      const auto choice = faces->by_power().sample(numbers.of[kVertexLight][lane]);
      face_[lane] = choice.index;
      choices_.probability[lane] = double(choice.pmf);
      faces_.u[0][lane] = choice.u;
      faces_.u[1][lane] = numbers.of[kVertexLight + 1][lane];
    }
  }
  sample_faces(p);
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    if (faces_.used >> lane & 1)
      look_at_face(lane, [](uint32_t) { return LightPath<float>{}; });
    else
      sample_shape(lane, p, numbers, {});
  }
}

// Samples the faces that lanes have chosen; not the lanes that have chosen an exact surface.
void LightStage::sample_faces(const Doubles (&p)[3]) {
  faces_.used = 0;
  for (uint32_t rest = emitters_; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    const Emitter &emitter = emitter_of(lane);
    if (!emitter.faces())
      continue;
    const Instance &object = placed(lane);
    const MeshView &mesh = scene_.geometry.meshes[object.mesh];
    if (faces_.used == 0)
      std::fill_n(faces_.placement, kBlockLanes, object.placement());
    faces_.used |= 1u << lane;
    faces_.placement[lane] = object.placement();
    for (int corner = 0; corner < 3; ++corner)
      put(mesh.vertex(face_[lane], corner, time_[lane]), faces_.corner[corner], lane);
  }
  if (faces_.used == 0)
    return;
  for (int axis = 0; axis < 3; ++axis)
    std::copy_n(p[axis], kBlockLanes, faces_.p[axis]);
  kernel_.sample_faces(faces_);
}

// Moves the end of a ray from a vertex to the sampled point at this distance.
void LightStage::reach(LightPath<float> &path, double distance) const {
  path.length = float(distance / scene_.normalisation.scale);
  path.width += float(distance) * path.spread;
}

glm::vec3 LightStage::face_emission(uint32_t lane, LightPath<float> path) {
  Hit hit;
  hit.instance = emitter_of(lane).instance();
  hit.primitive = face_[lane];
  hit.u = faces_.weights[0][lane];
  hit.v = faces_.weights[1][lane];
  Ray ray;
  ray.time = time_[lane];
  const Surface surface = surface_at(scene_.geometry, scene_.slots, ray, hit);
  reach(path, glm::length(surface.p - get(faces_.p, lane)));
  return emission_(surface, glm::vec3(-get(faces_.wi, lane)), path);
}

void LightStage::store_face(uint32_t lane, const glm::vec3 &radiance) {
  if (!(faces_.pdf[lane] > 0.0))
    return;
  put(get(faces_.wi, lane), samples_.wi, lane);
  put(get(faces_.target, lane), samples_.target, lane);
  put(radiance, samples_.radiance, lane);
  samples_.distance[lane] = faces_.distance[lane];
  samples_.pdf[lane] = faces_.pdf[lane] * choices_.probability[lane];
}

// Samples an exact surface that emits.
void LightStage::sample_shape(uint32_t lane, const Doubles (&p)[3], const VertexNumbers &numbers, LightPath<float> path) {
  const glm::dvec3 from = get(p, lane);
  Surface surface;
  const LightSample light =
      emitter_of(lane).sample_shape(scene_.geometry, scene_.slots, from, time_[lane],
                                    {numbers.of[kVertexLight][lane], numbers.of[kVertexLight + 1][lane]}, surface);
  if (!(light.pdf > 0.0))
    return;
  reach(path, glm::length(surface.p - from));
  put(light.wi, samples_.wi, lane);
  put(light.target, samples_.target, lane);
  put(emission_(surface, glm::vec3(-light.wi), path), samples_.radiance, lane);
  samples_.distance[lane] = light.distance;
  samples_.pdf[lane] = light.pdf * choices_.probability[lane];
}

// transmits: bits of the lanes whose surfaces transmit light.
void LightStage::sample_sky(const Doubles (&p)[3], const VertexNumbers &numbers, uint32_t transmits) {
  if (skies_ == 0)
    return;
  for (int axis = 0; axis < 3 && sky_.asks_places(); ++axis)
    std::copy_n(p[axis], kBlockLanes, directions_.p[axis]);
  for (const bool through : {false, true}) {
    uint32_t rest = skies_ & (through ? transmits : ~transmits);
    if (rest == 0)
      continue;
    for (int i = 0; i < 2; ++i)
      std::copy_n(numbers.of[kVertexLight + i], kBlockLanes, directions_.u[i]);
    sky_.sample(directions_, through);
    for (; rest != 0; rest &= rest - 1) {
      const uint32_t lane = uint32_t(std::countr_zero(rest));
      put(get(directions_.wi, lane), samples_.wi, lane);
      samples_.pdf[lane] = choices_.probability[lane] * directions_.pdf[lane];
    }
  }
  samples_.far |= skies_;
  sky_.look(samples_.wi, skies_);
  each_lane(skies_, [&](uint32_t lane) { put(sky_.radiance(lane), samples_.radiance, lane); });
}

// Finds the densities that weigh samples of the environment from behind faces that do not transmit light.
void LightStage::weigh_from_behind(const LobeBlock &lobes) {
  each_lane(skies_ & ~lobes.transmits, [&](uint32_t lane) {
    if (glm::dot(glm::dvec3(get(lobes.ng, lane)), get(samples_.wi, lane)) < 0.0)
      samples_.weighed[lane] =
          choices_.probability[lane] * scene_.lights.environment().pdf_in_proportion(get(samples_.radiance, lane));
  });
}

SkyStage::SkyStage(const Scene &scene, const Camera *camera) : scene_(scene), values_(scene.world.program.value_count()) {
  openings_ = scene.lights.openings();
  if (scene.lights.environment().is_light())
    for (const bool transmits : {false, true})
      maps_[transmits] = scene.lights.environment().table(transmits);
  nodes_.scene = scene.node_scene(camera);
  nodes_.surface = false;
}

void SkyStage::sample(SkyBlock &block, bool transmits) const {
  if (openings_.any())
    light_kernel().sample_sky_through(maps_[transmits], openings_, block);
  else
    light_kernel().sample_sky(maps_[transmits], block);
}

void SkyStage::find_density(SkyBlock &block, bool transmits) const {
  if (openings_.any())
    light_kernel().sky_density_through(maps_[transmits], openings_, block);
  else
    light_kernel().sky_density(maps_[transmits], block);
}

void SkyStage::look(const Doubles (&wi)[3], uint32_t lanes) {
  if (!scene_.world.varies())
    return;
  nodes_.used = lanes;
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      // The normals of the world's surface point back to the viewer.
      const float back = float(-wi[axis][lane]);
      nodes_.p[axis][lane] = -double(back);
      nodes_.wo[axis][lane] = nodes_.ns[axis][lane] = nodes_.ng[axis][lane] = back;
    }
  node_kernel().run(scene_.world.program, scene_.world.schedule, nodes_, values_.data());
}

} // namespace lancer
