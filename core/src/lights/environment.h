// What shines from beyond everything: its radiance in a direction, and directions by how bright it is there.
#pragma once

#include "accel/accelerator.h"
#include "lights/light.h"
#include "sampling/direction_map.h"
#include "scene/world.h"

namespace lancer {

class Environment {
public:
  // Black.
  Environment() = default;
  // The world, images and normalisation must outlive it; they may still be filled while it is made. Where the radiance varies,
  // looks at all directions for the map that they are sampled by.
  Environment(const World &world, const std::vector<Image> &images, const Normalisation &normalisation,
              const BuildContext &context);

  // One radiance in all directions: found best by the BSDF's own samples, so it is no light to sample.
  bool varies() const { return !map_.empty(); }
  const glm::vec3 &constant() const { return constant_; }
  uint32_t hidden_from() const { return hidden_from_; }
  // Mean over all directions, of the brightest channel.
  double mean() const { return mean_; }

  // wi: unit, world. values: room for all nodes of the world. camera (may be null) and is_camera_ray: for the nodes.
  glm::vec3 radiance(const glm::dvec3 &wi, std::span<glm::vec4> values, const Camera *camera = nullptr,
                     bool is_camera_ray = false) const {
    return varies() ? evaluate(wi, values, camera, is_camera_ray) : constant_;
  }
  // No sample where it does not vary.
  LightSample sample(const glm::vec2 &u, std::span<glm::vec4> values) const;
  // Density per solid angle with which sample() gives wi.
  double pdf(const glm::dvec3 &wi) const { return varies() ? map_.pdf(wi) : 0.0; }

  size_t bytes() const { return map_.bytes(); }

private:
  glm::vec3 evaluate(const glm::dvec3 &wi, std::span<glm::vec4> values, const Camera *camera, bool is_camera_ray) const;
  void make_map(const BuildContext &context);

  const World *world_ = nullptr;
  const std::vector<Image> *images_ = nullptr;
  const Normalisation *normalisation_ = nullptr;
  glm::vec3 constant_{0.0f};
  double mean_ = 0.0;
  uint32_t hidden_from_ = 0;
  DirectionMap map_;
};

} // namespace lancer
