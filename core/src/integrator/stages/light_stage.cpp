#include "integrator/stages/light_stage.h"

#include <algorithm>
#include <cmath>

namespace lancer {

LightStage::LightStage(const Scene &scene, const Camera &camera, SurfaceStage &surfaces)
    : scene_(scene), shader_(scene, &camera), surfaces_(surfaces), block_(surfaces.block),
      values_(scene.world.program.nodes.size()) {
  if (scene.lights.environment().is_light())
    for (const bool transmits : {false, true})
      sky_[transmits] = scene.lights.environment().table(transmits);
  nodes_.scene = shader_.node_scene();
  nodes_.surface = false;
}

LightQuery LightStage::query(uint32_t lane) const {
  return LightQuery(get(block_.p, lane), get(block_.viewer_ns, lane), block_.transmits >> lane & 1);
}

// Continues the choice in the lanes that have chosen the cluster of all lights with a position.
void LightStage::choose_of_many(uint32_t asking) {
  if (scene_.lights.wide_tree().empty())
    return;
  LightWalk walks[kBlockLanes];
  uint32_t lanes[kBlockLanes], count = 0;
  for (uint32_t lane = 0; lane < surfaces_.count(); ++lane)
    if (block_.chosen[lane] == scene_.lights.size() && block_.chosen_probability[lane] > 0.0 && asking >> lane & 1) {
      walks[count] = LightTree::walk(query(lane), block_.chosen_rest[lane]);
      lanes[count++] = lane;
    }
  scene_.lights.wide_tree().choose({walks, count});
  for (uint32_t i = 0; i < count; ++i) {
    block_.chosen[lanes[i]] = walks[i].number;
    block_.chosen_probability[lanes[i]] *= walks[i].probability;
    block_.chosen_rest[lanes[i]] = walks[i].u;
  }
}

LightStage::Chosen LightStage::choose(uint32_t asking) {
  static const Light nothing;
  Chosen chosen;
  block_.asked = 0;
  const BinaryLightTree &few = scene_.lights.binary_tree();
  if (!few.empty()) {
    block_.light_nodes = few.nodes();
    surfaces_.kernel.choose(block_);
    choose_of_many(asking);
  }
  for (uint32_t lane = 0; lane < kBlockLanes; ++lane) {
    block_.lamp[lane] = &nothing;
    block_.light_pdf[lane] = 0.0;
    block_.light_delta[lane] = block_.light_hidden[lane] = 0;
    far_[lane] = false;
    if (few.empty() || !(asking & block_.scatters & block_.used & 1u << lane))
      continue;
    const LightSet::Choice choice{block_.chosen[lane], 0, block_.chosen_probability[lane]};
    if (!(choice.probability > 0.0))
      continue;
    choices_[lane] = choice;
    block_.light_hidden[lane] = scene_.lights.hidden_from(choice.light);
    block_.light_pdf[lane] = choice.probability;
    if (choice.light < scene_.lights.lights().size()) {
      const Light &lamp = scene_.lights.lights()[choice.light];
      block_.lamp[lane] = &lamp;
      far_[lane] = lamp.kind == LightKind::Sun;
      block_.asked |= 1u << lane;
    } else if (choice.light == scene_.lights.environment_light()) {
      chosen.skies |= 1u << lane;
    } else {
      chosen.emitters |= 1u << lane;
    }
  }
  chosen.emitters = choose_faces(chosen.emitters);
  return chosen;
}

// Continues the choice in the lanes that have chosen an emitter; lanes with the same emitter choose together. Returns the lanes
// that have chosen a face of positive probability.
uint32_t LightStage::choose_faces(uint32_t lanes) {
  uint32_t found = 0;
  while (lanes != 0) {
    const uint32_t light = choices_[std::countr_zero(lanes)].light;
    LightWalk walks[kBlockLanes];
    uint32_t of[kBlockLanes], count = 0;
    for (uint32_t rest = lanes; rest != 0; rest &= rest - 1)
      if (const uint32_t lane = uint32_t(std::countr_zero(rest)); choices_[lane].light == light)
        of[count++] = lane;
    const Emitter &emitter = emitter_of(of[0]);
    if (emitter.faces()) {
      const Instance &placed = scene_.geometry.instances[emitter.instance()];
      for (uint32_t i = 0; i < count; ++i)
        walks[i] = emitter.faces()->walk(placed, query(of[i]), block_.chosen_rest[of[i]]);
      emitter.faces()->choose({walks, count});
    }
    for (uint32_t i = 0; i < count; ++i) {
      LightSet::Choice &choice = choices_[of[i]];
      if (emitter.faces()) {
        choice.face = walks[i].number;
        choice.probability *= walks[i].probability;
      }
      lanes &= ~(1u << of[i]);
      found |= uint32_t(choice.probability > 0.0) << of[i];
      block_.light_pdf[of[i]] = 0.0;
    }
  }
  return found;
}

// Samples the faces that lanes have chosen. Returns the sampled lanes, without the lanes that have chosen an exact surface.
uint32_t LightStage::sample_faces(uint32_t lanes) {
  faces_.used = 0;
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    const Emitter &emitter = emitter_of(lane);
    if (!emitter.faces())
      continue;
    const Instance &placed = scene_.geometry.instances[emitter.instance()];
    const Mesh &mesh = scene_.geometry.meshes[placed.mesh];
    if (faces_.used == 0)
      std::fill_n(faces_.placement, kBlockLanes, placed.placement());
    faces_.used |= 1u << lane;
    faces_.placement[lane] = placed.placement();
    for (int corner = 0; corner < 3; ++corner)
      put(mesh.vertex(choices_[lane].face, corner), faces_.corner[corner], lane);
  }
  if (faces_.used == 0)
    return 0;
  for (int axis = 0; axis < 3; ++axis)
    std::copy_n(block_.p[axis], kBlockLanes, faces_.p[axis]);
  for (int i = 0; i < 2; ++i)
    std::copy_n(block_.u[kVertexLight + i], kBlockLanes, faces_.u[i]);
  light_kernel().sample_faces(faces_);
  return faces_.used;
}

glm::vec3 LightStage::face_emission(uint32_t lane, LightPath<float> path) {
  Hit hit;
  hit.instance = emitter_of(lane).instance();
  hit.primitive = choices_[lane].face;
  hit.u = faces_.weights[0][lane];
  hit.v = faces_.weights[1][lane];
  const Surface surface = surface_at(scene_.geometry, scene_.slots, Ray{}, hit);
  path.length = float(glm::length(surface.p - get(block_.p, lane)) / scene_.normalisation.scale);
  return shader_.emission(surface, glm::vec3(-get(faces_.wi, lane)), path);
}

void LightStage::keep_face(uint32_t lane, const glm::vec3 &radiance) {
  if (!(faces_.pdf[lane] > 0.0) || radiance == glm::vec3(0.0f))
    return;
  put(get(faces_.wi, lane), block_.light_wi, lane);
  put(get(faces_.target, lane), block_.light_target, lane);
  put(radiance, block_.light_radiance, lane);
  block_.light_pdf[lane] = faces_.pdf[lane] * choices_[lane].probability;
}

void LightStage::sample_emitter(uint32_t lane, const LightPath<float> &path) {
  const LightSet::Choice &choice = choices_[lane];
  const LightSample light = sample_scene_light(scene_, choice, get(block_.p, lane),
                                               {block_.u[kVertexLight][lane], block_.u[kVertexLight + 1][lane]}, shader_, path);
  if (!(light.pdf > 0.0) || light.radiance == glm::vec3(0.0f))
    return;
  far_[lane] = std::isinf(light.distance);
  put(light.wi, block_.light_wi, lane);
  put(light.target, block_.light_target, lane);
  put(light.radiance, block_.light_radiance, lane);
  block_.light_pdf[lane] = light.pdf * choice.probability;
  block_.light_delta[lane] = light.delta;
}

// Sets the inputs of the world's nodes for a lane. eye: where a camera ray begins, null for any other ray.
void LightStage::see_sky(uint32_t lane, LightPath<float> path, const glm::dvec3 *eye) {
  nodes_.eye[lane] = eye;
  path.length = std::numeric_limits<float>::max();
  put(path, nodes_, lane);
}

// Evaluates the nodes of the world in these directions.
void LightStage::ask_world(const VertexBlock::Doubles (&wi)[3], uint32_t lanes) {
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

glm::vec3 LightStage::sky_radiance(uint32_t lane) const {
  const auto &value = values_[size_t(scene_.world.radiance.node)].of;
  return {value[0][lane], value[1][lane], value[2][lane]};
}

void LightStage::sample_sky(uint32_t lanes) {
  for (const bool transmits : {false, true}) {
    uint32_t rest = lanes & (transmits ? block_.transmits : ~block_.transmits);
    if (rest == 0)
      continue;
    for (int i = 0; i < 2; ++i)
      std::copy_n(block_.u[kVertexLight + i], kBlockLanes, samples_.u[i]);
    light_kernel().sample_sky(sky_[transmits], samples_);
    for (; rest != 0; rest &= rest - 1) {
      const uint32_t lane = uint32_t(std::countr_zero(rest));
      far_[lane] = true;
      put(get(samples_.wi, lane), block_.light_wi, lane);
      block_.light_pdf[lane] *= samples_.pdf[lane];
    }
  }
  ask_world(block_.light_wi, lanes);
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const uint32_t lane = uint32_t(std::countr_zero(rest));
    const glm::vec3 radiance = sky_radiance(lane);
    put(radiance, block_.light_radiance, lane);
    if (radiance == glm::vec3(0.0f))
      block_.light_pdf[lane] = 0.0;
  }
}

void LightStage::add_miss(uint32_t lane, const glm::dvec3 &d, LightPath<float> path, const glm::dvec3 *eye) {
  put(glm::normalize(d), misses_.wi, lane);
  // A ray that hits nothing has one scattering more in its depth, as in Cycles.
  path.depth += 1.0f;
  see_sky(lane, path, eye);
}

void LightStage::look_at_sky(uint32_t count) {
  const Environment &environment = scene_.lights.environment();
  for (const bool transmits : {false, true}) {
    // Most scenes have one map.
    if (environment.is_light() && (!transmits || environment.has_map_of_glass()))
      light_kernel().sky_density(sky_[transmits], misses_);
    std::copy_n(misses_.pdf, kBlockLanes, miss_pdf_[transmits]);
  }
  ask_world(misses_.wi, (1u << count) - 1u);
}

} // namespace lancer
