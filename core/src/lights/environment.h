// The environment: its radiance in a direction, and sampling of directions by their brightness, and of the discs of suns.
#pragma once

#include "lights/light.h"
#include "lights/suns.h"
#include "nodes/light_path.h"
#include "sampling/direction_map.h"
#include "scene/light.h"
#include "simd/parallel.h"

namespace lancer {

struct Camera;
struct Normalisation;

// The map that directions are sampled from: its cells, and the number of lookups along each side of a cell.
struct MapSize {
  uint32_t width = 0, height = 0, looks = 0;
};
// Returns the size of the map. resolution: the user's, 0 = by the images; widest: the width of the widest image, 0 = none.
MapSize map_size(uint32_t resolution, uint32_t widest);

class Environment {
public:
  // Makes a black environment.
  Environment() = default;
  // The memory of the world and the normalisation must outlive the environment. Where the radiance differs between directions,
  // the constructor evaluates it in all of them and makes the sampling maps. No camera is known at that time: where nodes read
  // the camera, the map is a guess, and the uniform share of the samples covers the rest. Surfaces sample in proportion to the
  // radiance above the mean, because BSDF samples find the rest equally well (Karlik et al., "MIS Compensation: Optimizing
  // Sampling Techniques in Multiple Importance Sampling", 2019). Under two pictures of the sky, this leaves 0.48 and 0.83 of
  // the variance. Glass samples from a second map, proportional to the radiance as in Cycles. It needs that density because the
  // light that a rough boundary transmits between two directions that no facet connects depends on the density of light samples
  // (Bsdf::eval_lit). The discs of suns are sampled apart, uniformly: the maps do not contain them, and no disc is too small.
  // opened: directions are also sampled through openings, which makes a light of any environment that is not black.
  Environment(const WorldView &world, const Normalisation &normalisation, const BuildContext &context, bool glass,
              bool opened = false);

  // Makes the environment of the same world, with the same demand for glass, in another scene.
  Environment(const Environment &other, const Normalisation &normalisation) : Environment(other) {
    normalisation_ = &normalisation;
  }

  // Whether the radiance depends on the direction or the path. A constant environment is no light to sample, unless there are
  // openings: BSDF samples find it best.
  bool varies() const { return world_.varies(); }
  // Whether the environment is sampled: its radiance differs between directions, or there are openings. Otherwise BSDF samples
  // find radiance that depends on the path alone, as in Cycles.
  bool is_light() const { return !maps_->above_mean.empty(); }
  const glm::vec3 &constant() const { return constant_; }
  uint32_t hidden_from() const { return hidden_from_; }
  uint32_t light_group() const { return world_.light_group; }
  uint32_t lit_surfaces() const { return world_.lit_surfaces; }
  // Largest angle over which images with mipmaps are averaged for other rays than the camera's: as in Cycles, a cell of the map
  // that Cycles samples.
  float finest() const { return finest_; }
  // Mean over all directions of the mean of the channels.
  double mean() const { return mean_; }

  // Returns the radiance. wi: unit, world. values: room for all nodes of the world. camera: for the nodes, may be null. eye:
  // where a camera ray starts; null for other rays. path: of the ray that sees the environment; default where it is sampled as
  // a light.
  glm::vec3 radiance(const glm::dvec3 &wi, std::span<glm::vec4> values, const Camera *camera, const glm::dvec3 *eye = nullptr,
                     const LightPath<float> &path = {}) const {
    return varies() ? evaluate(wi, values, camera, eye, path) : constant_;
  }
  // Computes the nodes of the world's outputs. Arguments as of radiance().
  void run_outputs(const glm::dvec3 &wi, std::span<glm::vec4> values, const Camera *camera, const glm::dvec3 *eye,
                   const LightPath<float> &path) const {
    run_nodes(world_.program, world_.output_nodes, wi, values, camera, eye, path);
  }
  // Returns pdf 0 where the environment is not a light. transmits: whether the surface may transmit light.
  LightSample sample(const glm::vec2 &u, std::span<glm::vec4> values, const Camera *camera, bool transmits) const;
  // Returns the density per solid angle with which sample() gives wi, evaluated for wi rounded to float, as nodes read it.
  double pdf(const glm::dvec3 &wi, bool transmits) const { return is_light() ? map(transmits).pdf(glm::vec3(wi)) : 0.0; }
  // Returns the density of a direction of this radiance where directions are sampled in proportion to it. By this density
  // Cycles weighs light samples that arrive from behind the face, where the shading normal lets them shine. BSDF samples never
  // take these directions, so that the weight stays in the picture. The map of Cycles is taken to be as fine as the radiance.
  double pdf_in_proportion(const glm::vec3 &radiance) const;

  // The map for kernels. The environment must be a light; the table is valid as long as one with the same maps is.
  DirectionTable table(bool transmits) const { return map(transmits).table(); }
  bool has_map_of_glass() const { return !maps_->in_proportion.empty(); }

  size_t bytes() const { return maps_->above_mean.bytes() + maps_->in_proportion.bytes(); }

private:
  glm::vec3 evaluate(const glm::dvec3 &wi, std::span<glm::vec4> values, const Camera *camera, const glm::dvec3 *eye,
                     const LightPath<float> &path = {}) const {
    return evaluate(world_.program, wi, values, camera, eye, path);
  }
  glm::vec3 evaluate(const ProgramView &program, const glm::dvec3 &wi, std::span<glm::vec4> values, const Camera *camera,
                     const glm::dvec3 *eye, const LightPath<float> &path = {}) const;
  void run_nodes(const ProgramView &program, ScheduleView schedule, const glm::dvec3 &wi, std::span<glm::vec4> values,
                 const Camera *camera, const glm::dvec3 *eye, const LightPath<float> &path) const;
  void make_maps(const BuildContext &context, bool glass);
  // Makes a map of equal densities.
  void make_even_map();
  // Returns the integral of a sun's weight over its disc. plain: the nodes without the suns.
  double flux_of(const Sun &sun, const ProgramView &plain) const;
  const DirectionMap &map(bool transmits) const {
    return transmits && has_map_of_glass() ? maps_->in_proportion : maps_->above_mean;
  }

  WorldView world_;
  const Normalisation *normalisation_ = nullptr;
  glm::vec3 constant_{0.0f};
  double mean_ = 0.0;
  float finest_ = 0.0f;
  uint32_t hidden_from_ = 0;
  // Shared by scenes with the same world.
  struct Maps {
    DirectionMap above_mean, in_proportion;
  };
  std::shared_ptr<const Maps> maps_ = std::make_shared<const Maps>();
};

} // namespace lancer
