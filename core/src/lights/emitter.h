// An object whose material emits, as a light: a face by how much it matters, points of it by the angle that they fill where it
// is near, by area where it is far.
#pragma once

#include "lights/emissive_faces.h"

#include <memory>

namespace lancer {

// One instance of the normalised world. What is never sampled is still found by chance, and pdf() is 0 there.
class Emitter {
public:
  // Of a mesh; faces are not empty.
  Emitter(const Geometry &geometry, uint32_t instance, std::shared_ptr<const EmissiveFaces> faces);
  // Of an exact surface. Where none of it emits: empty().
  Emitter(const Geometry &geometry, const std::vector<uint32_t> &slots, const std::vector<Material> &materials,
          uint32_t instance, const EmissionAt &emission);

  bool empty() const { return !(bounds_.energy > 0.0); }
  uint32_t instance() const { return instance_; }
  uint32_t hidden_from() const { return hidden_from_; }
  const LightBounds &bounds() const { return bounds_; }
  const std::shared_ptr<const EmissiveFaces> &faces() const { return faces_; }

  // A face for a point to ask, and with which probability; of an exact surface there is one only, number 0.
  LightChoice choose_face(const Geometry &geometry, const LightQuery &query, double u) const {
    return faces_ ? faces_->choose(geometry.instances[instance_], query, u) : LightChoice{0, 1.0, u};
  }
  double face_probability(const Geometry &geometry, const LightQuery &query, uint32_t face) const {
    return faces_ ? faces_->probability(geometry.instances[instance_], query, face) : double(!empty());
  }
  // A point of a face as seen from p. The caller asks the material what it emits there: radiance is left 0, surface says where.
  LightSample sample_face(const Geometry &geometry, const std::vector<uint32_t> &slots, uint32_t face, const glm::dvec3 &p,
                          const glm::vec2 &u, Surface &surface) const;
  // Density per solid angle of having sampled this surface point from p, once its face is chosen.
  double face_pdf(const Geometry &geometry, const glm::dvec3 &p, const Surface &surface) const;

  // The same with a face chosen by power alone.
  LightSample sample(const Geometry &geometry, const std::vector<uint32_t> &slots, const glm::dvec3 &p, const glm::vec2 &u,
                     Surface &surface) const;
  double pdf(const Geometry &geometry, const glm::dvec3 &p, const Surface &surface) const;

private:
  uint32_t instance_ = kNone, hidden_from_ = 0;
  LightBounds bounds_;
  std::shared_ptr<const EmissiveFaces> faces_; // of a mesh
  WeightedChoice parts_;                       // of an exact surface
};

} // namespace lancer
