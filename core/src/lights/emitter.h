// An object whose material emits, as a light: points by area, weighted with how bright each face is.
#pragma once

#include "lights/light.h"
#include "sampling/distribution.h"
#include "scene/material.h"

namespace lancer {

class Emitter {
public:
  // Tables for one instance of the normalised world; no faces that emit: empty().
  Emitter(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
          uint32_t instance);

  bool empty() const { return !(weight_ > 0.0); }
  uint32_t instance() const { return instance_; }
  // Power over pi: area times luminance-like emission, both sides.
  double weight() const { return weight_; }
  size_t bytes() const { return faces_.size() * sizeof(double); }

  LightSample sample(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
                     const glm::dvec3 &p, const glm::vec2 &u) const;
  // Density per solid angle of having sampled this surface point from p.
  double pdf(const Geometry &geometry, const std::vector<Material> &materials, const glm::dvec3 &p,
             const Surface &surface) const;

private:
  uint32_t instance_ = kNone;
  double weight_ = 0.0;
  Distribution faces_;
};

} // namespace lancer
