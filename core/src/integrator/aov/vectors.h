// The pass Vector: how far the first surface moves in the picture between the moments of scene/vectors.h, in pixels.
//
// In: the surface that the camera sees, or the direction in which it sees none. Out: SampleResult::vector and its weight.
// Callers: all integrators.
#pragma once

#include "integrator/sample.h"
#include "scene/surface.h"

namespace lancer {

class Vectors {
public:
  // All references must outlive the object.
  Vectors(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);

  bool wanted() const { return wanted_; }
  // Records the surface. Of a mesh, primitive and bary are read.
  void record(const Surface &surface, SampleResult &result) const {
    if (wanted_)
      record_surface(surface, result);
  }
  // Records a ray of the camera that sees no surface, where the settings ask for it. d: of any length.
  void record_sky(const glm::dvec3 &d, SampleResult &result) const {
    if (sky_)
      record_direction(d, result);
  }

private:
  void record_surface(const Surface &surface, SampleResult &result) const;
  void record_direction(const glm::dvec3 &d, SampleResult &result) const;

  const Scene &scene_;
  const Camera &camera_;
  const CameraMoments *moments_; // null: the camera stands still
  bool wanted_, sky_;
};

// Whether samples that see no surface have different vectors.
bool sky_vectors_vary(const IntegratorSettings &settings);

} // namespace lancer
