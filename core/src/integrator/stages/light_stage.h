// Light for the lanes of a block: the choice of a light, its sample, and the radiance of the sky in given directions.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/lane_access.h"
#include "integrator/stages/shading.h"
#include "integrator/stages/surface_stage.h"
#include "lights/sample_light.h"
#include "nodes/light_path.h"

#include <bit>

namespace lancer {

// One object per thread: it works on the block of its surfaces.
class LightStage {
public:
  LightStage(const Scene &scene, const Camera &camera, SurfaceStage &surfaces);

  // Chooses a light for each of these lanes and samples it into the block. path(lane): returns the Light Path values of the
  // vertex.
  template <class PathOf> void ask(uint32_t lanes, PathOf &&path) {
    const Chosen chosen = choose(lanes);
    const uint32_t sampled = sample_faces(chosen.emitters);
    for (uint32_t rest = chosen.emitters; rest != 0; rest &= rest - 1) {
      const uint32_t lane = uint32_t(std::countr_zero(rest));
      if (sampled >> lane & 1)
        look_at_face(lane, path);
      else
        sample_emitter(lane, path(lane));
    }
    if (chosen.skies == 0)
      return;
    for (uint32_t rest = chosen.skies; rest != 0; rest &= rest - 1) {
      const uint32_t lane = uint32_t(std::countr_zero(rest));
      see_sky(lane, path(lane), nullptr);
    }
    sample_sky(chosen.skies);
  }
  // Returns the light that a lane has chosen.
  uint32_t light(uint32_t lane) const { return choices_[lane].light; }
  // Writes the ray from a lane to its light sample in place.
  void write_shadow_ray(uint32_t lane, Ray &ray) const { surfaces_.write_shadow_ray(lane, far_[lane], ray); }

  // The sky in the directions of rays that hit nothing: add the directions lane by lane, evaluate all lanes, then read the
  // results.
  void add_miss(uint32_t lane, const glm::dvec3 &d, LightPath<float> path, const glm::dvec3 *eye);
  void look_at_sky(uint32_t count);
  glm::vec3 sky_radiance(uint32_t lane) const;
  // Returns the density with which the sky's map gives the direction of a miss; the environment must be a light. transmits: as
  // in the query of the last scattering.
  double sky_pdf(uint32_t lane, bool transmits) const { return miss_pdf_[transmits][lane]; }

private:
  // Lanes whose lights are sampled outside the kernels.
  struct Chosen {
    uint32_t emitters = 0, skies = 0;
  };

  LightQuery query(uint32_t lane) const;
  void choose_of_many(uint32_t lanes);
  uint32_t choose_faces(uint32_t lanes);
  Chosen choose(uint32_t lanes);
  uint32_t sample_faces(uint32_t lanes);
  // Computes the light that a lane gets from its sampled point of a face.
  template <class PathOf> void look_at_face(uint32_t lane, PathOf &&path) {
    const Emitter &emitter = emitter_of(lane);
    const uint32_t number = material_of(scene_.geometry, scene_.slots, emitter.instance(), choices_[lane].face);
    if (number == kNone)
      return;
    const Material &material = scene_.materials[number];
    keep_face(lane, emission_varies(material) ? face_emission(lane, path(lane)) : material.emission.value);
  }
  glm::vec3 face_emission(uint32_t lane, LightPath<float> path);
  void keep_face(uint32_t lane, const glm::vec3 &radiance);
  void sample_emitter(uint32_t lane, const LightPath<float> &path);
  const Emitter &emitter_of(uint32_t lane) const {
    return scene_.lights.emitters()[choices_[lane].light - scene_.lights.lights().size()];
  }
  void sample_sky(uint32_t lanes);
  void see_sky(uint32_t lane, LightPath<float> path, const glm::dvec3 *eye);
  void ask_world(const VertexBlock::Doubles (&wi)[3], uint32_t lanes);

  const Scene &scene_;
  Shader shader_;
  SurfaceStage &surfaces_;
  VertexBlock &block_;
  LightSet::Choice choices_[kBlockLanes];
  bool far_[kBlockLanes] = {}; // the light is at infinity
  // By LightQuery::transmits.
  DirectionTable sky_[2];
  SkyBlock misses_{}, samples_{};
  double miss_pdf_[2][kBlockLanes] = {};
  FaceBlock faces_;
  NodeBlock nodes_; // of the world
  std::vector<NodeLanes> values_;
};

} // namespace lancer
