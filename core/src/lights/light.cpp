#include "lights/light.h"

#include "lights/sample_light.h"

namespace lancer {

LightSample sample(const Light &light, const glm::dvec3 &p, const glm::vec2 &u) {
  LightSampleLanes<float> found{};
  sample_light(OneLight<float>{light}, Vector3<double>(p), u.x, u.y, true, found);
  return {found.target, found.wi, found.distance, found.radiance, found.pdf, found.delta};
}

LightHit meet(const Light &light, const glm::dvec3 &o, const glm::dvec3 &wi) {
  const LightHitLanes<float> hit = meet_light(OneLight<float>{light}, Vector3<double>(o), Vector3<double>(wi));
  return hit.pdf > 0.0 ? LightHit{hit.radiance, hit.pdf, hit.distance} : LightHit{};
}

bool has_extent(const Light &light) {
  if (light.kind == LightKind::Sun)
    return light.one_minus_cos_sun > 0.0;
  return light.kind == LightKind::Area ? light.area > 0.0 : light.radius > 0.0;
}

} // namespace lancer
