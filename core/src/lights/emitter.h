// An object whose material emits, as a light: points by area, weighted with how bright each face is.
#pragma once

#include "lights/light.h"
#include "sampling/distribution.h"
#include "scene/material.h"

#include <functional>

namespace lancer {

// What a surface sends towards the unit world direction wo: nodes and layers are for the caller to evaluate.
using EmissionAt = std::function<glm::vec3(const Surface &surface, const glm::vec3 &wo)>;

class Emitter {
public:
  // Tables for one instance of the normalised world; no faces that emit: empty(). What is never sampled is still found by
  // chance, and pdf() is 0 there.
  Emitter(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
          uint32_t instance, const EmissionAt &emission);

  bool empty() const { return !(weight_ > 0.0); }
  uint32_t instance() const { return instance_; }
  uint32_t hidden_from() const { return hidden_from_; }
  // Power over pi: area times luminance-like emission, both sides.
  double weight() const { return weight_; }
  size_t bytes() const { return faces_.size() * sizeof(double) + brightness_.size() * sizeof(float); }

  // A point of it as seen from p. The caller asks the material what it emits there: radiance is left 0, surface says where.
  LightSample sample(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                     const glm::dvec3 &p, const glm::vec2 &u, Surface &surface) const;
  // Density per solid angle of having sampled this surface point from p.
  double pdf(const Geometry &geometry, const std::vector<Material> &materials, const glm::dvec3 &p,
             const Surface &surface) const;

private:
  void add_faces(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                 const EmissionAt &emission);
  void add_parts(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                 const EmissionAt &emission);
  double brightness(const Material &material, uint32_t face) const;

  uint32_t instance_ = kNone, hidden_from_ = 0;
  double weight_ = 0.0;
  WeightedChoice faces_;          // of a mesh; else the parts of an exact surface
  std::vector<float> brightness_; // per face, where a material's emission varies
};

} // namespace lancer
