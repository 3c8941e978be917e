// The strength of lamps with nodes at points of the lamps, in lanes.
//
// In: points of lamps that have nodes, from the light stage and the stage of met lights. Out: the factor of their light there.
#pragma once

#include "compile/scene.h"
#include "lights/lamp_shader.h"

namespace lancer {

class LampStage {
public:
  LampStage(const Scene &scene, const Camera *camera);

  // Sets the point of a lane's lamp, which must have a shader; path: of the ray, whose length follows from the distance. See
  // lamp_point().
  void set(uint32_t lane, const Light &light, const glm::dvec3 &target, const glm::dvec3 &wi, double distance,
           LightPath<float> path);
  // Evaluates these lanes; lanes with the same lamp together.
  void look(uint32_t lanes);
  glm::vec3 strength(uint32_t lane) const { return strength_[lane]; }

private:
  const LampShaders &shaders_;
  const Normalisation &normalisation_;
  NodeBlock block_{};
  std::vector<NodeLanes> values_;
  glm::vec3 strength_[kBlockLanes];
};

} // namespace lancer
