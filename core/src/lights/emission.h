// The light that surfaces emit, the emitting faces of a mesh with the choice among them, and objects whose material emits, as
// lights.
#pragma once

#include "bsdf/bsdf.h"
#include "lights/light_tree.h"
#include "nodes/run.h"
#include "sampling/distribution.h"
#include "scene/material.h"

#include <memory>

namespace lancer {

// Return whether light sampling chooses faces with this material, and whether their emission differs from place to place.
bool is_light(const MaterialView &material);
bool emission_varies(const MaterialView &material);
// Returns the weight of emitted light in a choice: the mean of the channels; 0 where no channel is positive or the mean is not
// finite.
double emission_level(const glm::vec3 &radiance);

// Evaluates the emission of surfaces. One object per thread: it keeps the values of nodes.
class EmissionAt {
public:
  // materials and all that scene points to must outlive this object.
  EmissionAt(const NodeScene &scene, std::span<const MaterialView> materials)
      : materials_(materials), nodes_(scene, most_values(materials)) {}

  // Returns the radiance that a surface emits towards the unit world direction wo. path: of the vertex that samples the light.
  glm::vec3 operator()(const Surface &surface, const glm::vec3 &wo, const LightPath<float> &path);
  // Returns the weight of a surface in a choice: seen along its normal from the brighter side, by a first surface's sample.
  double level(const Surface &surface);

private:
  std::span<const MaterialView> materials_;
  MaterialNodes nodes_;
  Bsdf<float> bsdf_; // scratch for emission below layers
};

// The emitting faces of a mesh and the choice among them. Instances of one mesh with the same materials share this record.
class EmissiveFaces {
public:
  // of_mesh: the tree is made in the object's space and serves all instances at all times, with the emission that this instance
  // has; otherwise it is made in world space. Throws BuildCancelled.
  EmissiveFaces(const GeometryView &geometry, std::span<const uint32_t> slots, std::span<const MaterialView> materials,
                uint32_t instance, bool of_mesh, EmissionAt &emission, const BuildContext &context);

  bool empty() const { return tree_.empty(); }
  // The choice by power, for callers without a shading normal.
  const WeightedChoice &by_power() const { return by_power_; }
  // Returns the walk that chooses a face for one point, by an upper bound of the light that the point gets from each. Walks for
  // several points are made together, and may belong to different instances of the mesh.
  LightWalk walk(const Instance &placed, const LightQuery &query, double u) const {
    return LightTree::walk(to_tree(placed, query), u);
  }
  void choose(std::span<LightWalk> walks) const { tree_.choose(walks); }
  double probability(const Instance &placed, const LightQuery &query, uint32_t face) const {
    return tree_.probability(to_tree(placed, query), face);
  }
  // Returns bounds in world space; their energy is radiance times area.
  LightBounds bounds(const Instance &placed) const;
  size_t bytes() const { return tree_.bytes() + by_power_.size() * sizeof(double); }

private:
  // Returns radiance times area of each face, in the space of the tree.
  std::vector<double> powers(const GeometryView &geometry, std::span<const uint32_t> slots,
                             std::span<const MaterialView> materials, uint32_t instance, EmissionAt &emission,
                             const BuildContext &context) const;
  LightQuery to_tree(const Instance &placed, const LightQuery &query) const;

  bool of_mesh_;
  // The tree's space is (p - centre_) * scale_.
  glm::dvec3 centre_{0.0};
  double scale_ = 1.0;
  WeightedChoice by_power_;
  LightTree tree_;
};

// An emitter is one instance in the normalised world. Rays may hit surfaces that are never sampled; pdf() returns 0 there.
class Emitter {
public:
  // Makes the emitter of a mesh; faces must not be empty.
  Emitter(const GeometryView &geometry, uint32_t instance, std::shared_ptr<const EmissiveFaces> faces);
  // Makes the emitter of an exact surface; empty() holds where the surface emits nothing.
  Emitter(const GeometryView &geometry, std::span<const uint32_t> slots, std::span<const MaterialView> materials,
          uint32_t instance, EmissionAt &emission);

  bool empty() const { return !(bounds_.energy > 0.0); }
  uint32_t instance() const { return instance_; }
  uint32_t hidden_from() const { return hidden_from_; }
  const LightLinks &links() const { return links_; }
  const LightBounds &bounds() const { return bounds_; }
  const std::shared_ptr<const EmissiveFaces> &faces() const { return faces_; }

  // Returns the probability with which a light sample at the point of the query chooses a face.
  double face_probability(const GeometryView &geometry, const LightQuery &query, float time, uint32_t face) const {
    Instance moved;
    return faces_ ? faces_->probability(geometry.placed_at(instance_, time, moved), query, face) : double(!empty());
  }
  // Samples a point of an exact surface at a time, seen from p, and writes it to surface. radiance stays 0: the caller
  // evaluates the material at that point.
  LightSample sample_shape(const GeometryView &geometry, std::span<const uint32_t> slots, const glm::dvec3 &p, float time,
                           const glm::vec2 &u, Surface &surface) const;
  // Returns the density per solid angle with which a light sample at the surface's time gives this point from p, once its face
  // is chosen.
  double face_pdf(const GeometryView &geometry, const glm::dvec3 &p, const Surface &surface) const;
  // The same for a face that is chosen by power alone.
  double pdf(const GeometryView &geometry, const glm::dvec3 &p, const Surface &surface) const;

private:
  uint32_t instance_ = kNone, hidden_from_ = 0;
  LightLinks links_;
  LightBounds bounds_;
  std::shared_ptr<const EmissiveFaces> faces_; // of a mesh
  WeightedChoice parts_;                       // of an exact surface
};

} // namespace lancer
