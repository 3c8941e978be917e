// Light samples of vertices, in lanes: the choice of a light, a point of the light, and the light that arrives from there
// unless a surface occludes it.
// In: surfaces, their lobes, numbers, throughputs and Light Paths, from an integrator. Out: LightSamples; for PATH LitBlock,
// with the radiance that light adds to the sample, for the shadow stage. Lengths are in the normalised world, densities per
// solid angle. Callers: PATH; CLASSIC, which samples each light in turn and fills a LitBlock of its own; the stage of met
// lights, which uses the kernel and the environment; the probes.
#pragma once

#include "compile/scene.h"
#include "integrator/stages/lamps.h"
#include "integrator/stages/numbers.h"
#include "integrator/stages/surface.h"
#include "lights/emission.h"
#include "lights/light_choice.h"
#include "lights/openings.h"
#include "nodes/run.h"
#include "simd/block.h"

namespace lancer {

// Directions to the environment, and the density with which its map gives them. u: in [0, 1) in all lanes, by the light stage;
// wi: by the kernel or the stage of met lights; pdf: by the kernel. p: from where the directions go, in scenes with openings.
struct alignas(64) SkyBlock {
  Floats u[2];
  Doubles wi[3], pdf; // wi: unit
  Doubles p[3];
};

// The environment for lanes of directions: its radiance there, and directions sampled by its brightness.
class SkyStage {
public:
  SkyStage(const Scene &scene, const Camera *camera);

  // Samples directions into block, from its numbers u. The environment must be a light. transmits: whether the surfaces may
  // transmit light, which decides the map.
  void sample(SkyBlock &block, bool transmits) const;
  // Computes the densities of the block's directions.
  void find_density(SkyBlock &block, bool transmits) const;
  // Whether directions depend on the place that they go from: the block's p must be set.
  bool asks_places() const { return openings_.any(); }

  // Evaluates the environment: set the path of each lane, look, then read the results. eye: where a camera ray begins, null for
  // any other ray.
  void set_path(uint32_t lane, const LightPath<float> &path, const glm::dvec3 *eye) {
    nodes_.eye[lane] = eye;
    put(path, nodes_, lane);
  }
  void look(const Doubles (&wi)[3], uint32_t lanes);
  glm::vec3 radiance(uint32_t lane) const {
    if (!scene_.world.varies())
      return scene_.world.radiance.value;
    const auto &value = values_[size_t(scene_.world.radiance.node)].of;
    return {value[0][lane], value[1][lane], value[2][lane]};
  }

private:
  const Scene &scene_;
  DirectionTable maps_[2]; // by transmits
  Openings openings_;
  NodeBlock nodes_{};
  std::vector<NodeLanes> values_;
};

// The members of LightChoice, by the kernel; rest: LightChoice::u. The number LightSet::size() stands for the tree of many
// lights, in which LightStage goes on to choose, as among the faces of an emitter.
struct alignas(64) LightChoices {
  Words number;
  Doubles probability, rest;
};

// The members of LightSample; target only of lights that are not far; distance: infinite for suns, unset for the environment.
// pdf includes the probability of the choice, 0: no sample; weighed: in place of pdf in the weight against BSDF samples, 0:
// pdf.
struct alignas(64) LightSamples {
  Doubles wi[3], target[3], distance, pdf, weighed;
  Floats radiance[3];
  Words delta, hidden; // hidden: RayKind bits of the rays that do not see the light; by LightStage
  uint32_t far = 0;    // bits of lanes: the light is at infinity; by LightStage
};

// One face of an emitting mesh for each lane, and the sample that a point takes of it.
struct alignas(64) FaceBlock {
  // In: the mesh's placement as Instance::placement(), the face's corners in object space, the shaded point, two numbers.
  const double *placement[kBlockLanes];
  Floats corner[3][3]; // by corner, axis
  Doubles p[3];
  Floats u[2];
  uint32_t used = 0; // bits of lanes
  // Out: the sample, as LightSample; its weights of corners 1 and 2; the face's normal, outwards.
  alignas(64) Doubles wi[3], target[3], distance, pdf, weights[2];
  Floats ng[3];
};

// The light of the samples without occlusion, for the bits lit: beta f |cos(wi)| radiance w / (pdf count). w is the weight
// against BSDF samples, by the power heuristic with one sample of each technique; 1 for single directions. CLASSIC has a
// formula of its own. origin: start of the shadow ray, off the surface on the side of wi.
struct alignas(64) LitBlock {
  Floats contribution[3];
  Floats share[2][3]; // diffuse and glossy share, where shares are wanted
  Doubles origin[3];
  uint32_t lit = 0;    // bits of lanes
  uint32_t lifted = 0; // bits of lanes: the shadow ray may have to start on the curved surface
};

// The vertices to light. beta: throughput from the vertex to the camera; count: number of lights sampled at the vertex.
struct LitVertices {
  const SurfaceBlock &surfaces;
  const LobeBlock &lobes;
  const Floats (&beta)[3];
  const Doubles &count;
};

// Segments of rays that hit a light, as LightHit, and the probability with which a light sample at the last scattering chooses
// the light.
struct alignas(64) MetBlock {
  Doubles pdf, distance, chosen;
  Floats radiance[3];
};

struct LightKernel {
  // Chooses a light of LightSet::binary_tree() for each lane.
  void (*choose)(const SurfaceBlock &surfaces, const LobeBlock &lobes, const VertexNumbers &numbers, const LightNodes &tree,
                 LightChoices &choices);
  // Sample a lamp for each of these lanes, or one lamp in all of them; the other lanes stay as they are. probability: of the
  // choice.
  void (*sample_lamps)(const Light *const *lamps, const Doubles (&p)[3], const VertexNumbers &numbers,
                       const Doubles &probability, uint32_t lanes, LightSamples &samples);
  void (*sample_lamp)(const Light &lamp, const Doubles (&p)[3], const VertexNumbers &numbers, uint32_t lanes,
                      LightSamples &samples);
  void (*sample_faces)(FaceBlock &block);
  // sample_sky samples directions of the environment from the numbers u; sky_density computes the density of given directions.
  void (*sample_sky)(const DirectionTable &map, SkyBlock &block);
  void (*sky_density)(const DirectionTable &map, SkyBlock &block);
  // The same in scenes with openings.
  void (*sample_sky_through)(const DirectionTable &map, const Openings &openings, SkyBlock &block);
  void (*sky_density_through)(const DirectionTable &map, const Openings &openings, SkyBlock &block);
  void (*light)(const LitVertices &vertices, const LightSamples &samples, LitBlock &lit);
  // Returns the bits of the lanes that may hit the light; other lanes miss it.
  uint32_t (*meets)(const SegmentBlock &segments, const Light &light);
  // Computes the light that lanes get when they hit it; place: of the light in the tree.
  void (*meet)(const SegmentBlock &segments, const Light &light, const LightNodes &tree, uint32_t place, MetBlock &met);
};
LANCER_DECLARE_KERNEL(LightKernel, light_kernel)

// One object per thread.
class LightStage {
public:
  LightStage(const Scene &scene, const Camera *camera);

  // Sets the set of receivers of a lane's surface; needed where lights are linked.
  void receive(uint32_t lane, uint32_t set) { receiver_set_[lane] = set; }
  // Chooses a light for each of these lanes and samples it. path(lane): returns the Light Path of a light sample at the vertex.
  template <class PathOf>
  void ask(uint32_t lanes, const SurfaceBlock &surfaces, const LobeBlock &lobes, const VertexNumbers &numbers, PathOf &&path) {
    time_ = surfaces.time;
    choose(lanes, surfaces, lobes, numbers);
    if (lamps_ != 0)
      kernel_.sample_lamps(lamp_, surfaces.p, numbers, choices_.probability, lamps_, samples_);
    if (has_lamp_shaders_)
      shade_lamps(path);
    sample_faces(surfaces.p);
    each_lane(emitters_, [&](uint32_t lane) {
      if (faces_.used >> lane & 1)
        look_at_face(lane, path);
      else
        sample_shape(lane, surfaces.p, numbers, path(lane));
    });
    each_lane(skies_, [&](uint32_t lane) {
      LightPath<float> of_lane = path(lane);
      of_lane.length = std::numeric_limits<float>::max();
      of_lane.width = of_lane.spread = std::min(of_lane.spread, scene_.lights.environment().finest());
      sky_.set_path(lane, of_lane, nullptr);
    });
    sample_sky(surfaces.p, numbers, lobes.transmits);
    weigh_from_behind(lobes);
  }
  // Samples this light in all of these lanes, seen from p at these times; an emitter's face by its power. The nodes of the
  // light see no path.
  void sample(uint32_t light, uint32_t lanes, const Doubles (&p)[3], const Floats &time, const VertexNumbers &numbers);
  // Computes the light of the samples that is not occluded.
  void light(const LitVertices &vertices) { kernel_.light(vertices, samples_, lit_); }

  const LightSamples &samples() const { return samples_; }
  const LitBlock &lit() const { return lit_; }
  // Returns the light that a lane has chosen.
  uint32_t chosen(uint32_t lane) const { return choices_.number[lane]; }

private:
  void choose(uint32_t lanes, const SurfaceBlock &surfaces, const LobeBlock &lobes, const VertexNumbers &numbers);
  void begin();
  void choose_by_sets(uint32_t lanes, const SurfaceBlock &surfaces, const LobeBlock &lobes, const VertexNumbers &numbers);
  void choose_of_many(uint32_t lanes, const LightTree &many, const SurfaceBlock &surfaces, const LobeBlock &lobes);
  void choose_faces(const SurfaceBlock &surfaces, const LobeBlock &lobes);
  void sample_faces(const Doubles (&p)[3]);
  // Stores the sample of a face with the light that its point emits.
  template <class PathOf> void look_at_face(uint32_t lane, PathOf &&path) {
    const uint32_t number = material_of(scene_.geometry, scene_.slots, emitter_of(lane).instance(), face_[lane]);
    if (number == kNone)
      return;
    const MaterialView &material = scene_.materials[number];
    store_face(lane, emission_varies(material) ? face_emission(lane, path(lane)) : material.emission.value);
  }
  void store_face(uint32_t lane, const glm::vec3 &radiance);
  void reach(LightPath<float> &path, double distance) const;
  glm::vec3 face_emission(uint32_t lane, LightPath<float> path);
  void sample_shape(uint32_t lane, const Doubles (&p)[3], const VertexNumbers &numbers, LightPath<float> path);
  void sample_sky(const Doubles (&p)[3], const VertexNumbers &numbers, uint32_t transmits);
  void weigh_from_behind(const LobeBlock &lobes);
  // Multiplies the radiance of lamps by what their nodes say.
  template <class PathOf> void shade_lamps(PathOf &&path) {
    uint32_t shaded = 0;
    each_lane(lamps_, [&](uint32_t lane) {
      if (lamp_[lane]->shader == kNone || !(samples_.pdf[lane] > 0.0))
        return;
      shaded |= 1u << lane;
      const double distance = samples_.far >> lane & 1 ? 0.0 : samples_.distance[lane];
      lamp_nodes_.set(lane, *lamp_[lane], get(samples_.target, lane), get(samples_.wi, lane), distance, path(lane));
    });
    lamp_nodes_.look(shaded);
    each_lane(shaded,
              [&](uint32_t lane) { put(get(samples_.radiance, lane) * lamp_nodes_.strength(lane), samples_.radiance, lane); });
  }
  // Returns the object of a lane's emitter as it is placed at the time of the lane.
  const Instance &placed(uint32_t lane) {
    const uint32_t instance = emitter_of(lane).instance();
    return placed_.empty() ? scene_.geometry.instances[instance]
                           : scene_.geometry.placed_at(instance, time_[lane], placed_[lane]);
  }
  const Emitter &emitter_of(uint32_t lane) const {
    return scene_.lights.emitters()[choices_.number[lane] - scene_.lights.lamps().size()];
  }

  const Scene &scene_;
  const LightKernel &kernel_;
  EmissionAt emission_;
  SkyStage sky_;
  LampStage lamp_nodes_;
  bool has_lamp_shaders_;
  LightChoices choices_{};
  uint32_t receiver_set_[kBlockLanes] = {};
  LightChoices of_set_{}; // of the receivers of one set
  const Light *lamp_[kBlockLanes];
  Words face_;                                    // of the chosen emitter
  const float *time_ = nullptr;                   // of the vertices, by lane
  std::vector<Instance> placed_;                  // by lane; empty where nothing moves
  uint32_t lamps_ = 0, emitters_ = 0, skies_ = 0; // lanes that have chosen these
  SkyBlock directions_{};
  FaceBlock faces_{};
  LightSamples samples_{};
  LitBlock lit_{};
};

} // namespace lancer
