// What shines from beyond everything: its radiance in a direction, and directions by how bright it is there.
#pragma once

#include "lights/light.h"
#include "nodes/light_path.h"
#include "sampling/direction_map.h"
#include "scene/light.h"
#include "simd/parallel.h"

namespace lancer {

struct Camera;
struct Normalisation;

// The map by which directions are sampled: its cells, and how often each is looked at along each of its sides.
struct MapSize {
  uint32_t width = 0, height = 0, looks = 0;
};
// resolution: the user's, 0 = by the images; widest: the width of the widest of them, 0 = none.
MapSize map_size(uint32_t resolution, uint32_t widest);

class Environment {
public:
  // Black.
  Environment() = default;
  // The world, images and normalisation must outlive it; they may still be filled while it is made. Where the radiance varies,
  // looks at all directions for the maps that they are sampled by. No camera is known then: where nodes ask for it a map is
  // only a guess, and the even share of the samples carries the rest.
  // Surfaces sample by what is brighter than the mean: the rest their BSDF finds as well (Karlik et al., "MIS Compensation:
  // Optimizing Sampling Techniques in Multiple Importance Sampling", 2019). Under two pictures of the sky that leaves 0.48 and
  // 0.83 of the variance.
  // What a rough boundary passes on where no facet connects depends on the density of the light's samples (Bsdf::eval_lit):
  // for glass, a second map is in proportion to the radiance, as in Cycles.
  Environment(const World &world, const std::vector<Image> &images, const Normalisation &normalisation,
              const BuildContext &context, bool glass);

  // One radiance in all directions: found best by the BSDF's own samples, so it is no light to sample.
  bool varies() const { return world_ && world_->varies(); }
  // Whether it is sampled: where directions differ. What only the path decides is found by the BSDF, as in Cycles.
  bool is_light() const { return !above_mean_.empty(); }
  const glm::vec3 &constant() const { return constant_; }
  uint32_t hidden_from() const { return hidden_from_; }
  // Mean over all directions, of the brightest channel.
  double mean() const { return mean_; }

  // wi: unit, world. values: room for all nodes of the world. camera: for the nodes, may be null. eye: where a camera ray
  // starts; null for other rays. path: of the ray that sees it; none where it is sampled as a light.
  glm::vec3 radiance(const glm::dvec3 &wi, std::span<glm::vec4> values, const Camera *camera, const glm::dvec3 *eye = nullptr,
                     const LightPath<float> &path = {}) const {
    return varies() ? evaluate(wi, values, camera, eye, path) : constant_;
  }
  // No sample where it is no light. transmits: whether light may come through the surface that asks.
  LightSample sample(const glm::vec2 &u, std::span<glm::vec4> values, const Camera *camera, bool transmits) const;
  // Density per solid angle with which sample() gives wi; of the direction that nodes see, in floats.
  double pdf(const glm::dvec3 &wi, bool transmits) const { return is_light() ? map(transmits).pdf(glm::vec3(wi)) : 0.0; }

  // For kernels, as long as this is neither changed nor moved; only of a light.
  DirectionTable table(bool transmits) const { return map(transmits).table(); }
  bool has_map_of_glass() const { return !in_proportion_.empty(); }

  size_t bytes() const { return above_mean_.bytes() + in_proportion_.bytes(); }

private:
  glm::vec3 evaluate(const glm::dvec3 &wi, std::span<glm::vec4> values, const Camera *camera, const glm::dvec3 *eye,
                     const LightPath<float> &path = {}) const;
  void make_maps(const BuildContext &context, bool glass);
  const DirectionMap &map(bool transmits) const { return transmits && has_map_of_glass() ? in_proportion_ : above_mean_; }

  const World *world_ = nullptr;
  const std::vector<Image> *images_ = nullptr;
  const Normalisation *normalisation_ = nullptr;
  glm::vec3 constant_{0.0f};
  double mean_ = 0.0;
  uint32_t hidden_from_ = 0;
  DirectionMap above_mean_, in_proportion_;
};

} // namespace lancer
