// An object whose material emits, as a light. A face is chosen by its importance; a point on it is sampled by solid angle where
// the face is near, by area where it is far.
#pragma once

#include "lights/emission.h"

#include <memory>

namespace lancer {

// An emitter is one instance in the normalised world. Rays may hit surfaces that are never sampled; pdf() returns 0 there.
class Emitter {
public:
  // Makes the emitter of a mesh; faces must not be empty.
  Emitter(const Geometry &geometry, uint32_t instance, std::shared_ptr<const EmissiveFaces> faces);
  // Makes the emitter of an exact surface; empty() holds where the surface emits nothing.
  Emitter(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
          uint32_t instance, EmissionAt &emission);

  bool empty() const { return !(bounds_.energy > 0.0); }
  uint32_t instance() const { return instance_; }
  uint32_t hidden_from() const { return hidden_from_; }
  const LightBounds &bounds() const { return bounds_; }
  const std::shared_ptr<const EmissiveFaces> &faces() const { return faces_; }

  // Returns the probability with which a light sample at the point of the query chooses a face.
  double face_probability(const Geometry &geometry, const LightQuery &query, uint32_t face) const {
    return faces_ ? faces_->probability(geometry.instances[instance_], query, face) : double(!empty());
  }
  // Samples a point of an exact surface, seen from p, and writes it to surface. radiance stays 0: the caller evaluates the
  // material at that point.
  LightSample sample_shape(const Geometry &geometry, const std::vector<uint32_t> &slots, const glm::dvec3 &p,
                           const glm::vec2 &u, Surface &surface) const;
  // Returns the density per solid angle with which a light sample gives this surface point from p, once its face is chosen.
  double face_pdf(const Geometry &geometry, const glm::dvec3 &p, const Surface &surface) const;
  // The same for a face that is chosen by power alone.
  double pdf(const Geometry &geometry, const glm::dvec3 &p, const Surface &surface) const;

private:
  uint32_t instance_ = kNone, hidden_from_ = 0;
  LightBounds bounds_;
  std::shared_ptr<const EmissiveFaces> faces_; // of a mesh
  WeightedChoice parts_;                       // of an exact surface
};

} // namespace lancer
