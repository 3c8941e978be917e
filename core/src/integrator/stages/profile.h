// Burley's profile: from the entry of a path into a surface to the place, on the same instance, where the path leaves it again.
//
// In: walks of the method Burley, from the walk stage. Out: for each the hit from outside and the new throughput, or none if
// the path is lost. Lengths are in the normalised world. Caller: the walk stage.
#pragma once

#include "integrator/stages/own_hits.h"
#include "integrator/stages/walk_record.h"
#include "sampling/axis_probe.h"

namespace lancer {

class ProfileStage {
public:
  explicit ProfileStage(const Scene &scene) : scene_(scene), own_(scene) {}

  // Ends the walks of these numbers. Returns the number of rays.
  uint64_t leave(std::span<Walk> walks, std::span<const size_t> numbers);

private:
  // A ray through a point of a disk around the entry: the radii of the profile, and the distance of the point.
  struct Probe {
    AxisProbe axes;
    glm::vec3 radius;
    float r;
  };

  void send(const Walk &walk);
  glm::vec3 weight(const Walk &walk, const Probe &probe, const Surface &surface) const;
  void choose(Walk &walk, size_t number);

  const Scene &scene_;
  OwnHits own_;
  // By probe.
  std::vector<Probe> probes_;
  std::vector<Ray> rays_;
  std::vector<uint32_t> instance_of_;
  // Hits of one probe.
  std::vector<Surface> surfaces_;
  std::vector<glm::vec3> weights_;
};

} // namespace lancer
