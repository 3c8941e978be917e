#include "lights/light.h"

#include "lights/area_light.h"
#include "lights/sun_light.h"

namespace lancer {

LightSample sample(const Light &light, const glm::dvec3 &p, const glm::vec2 &u) {
  switch (light.kind) {
  case LightKind::Point:
  case LightKind::Spot:
    return sample_point(light, p, u);
  case LightKind::Sun:
    return sample_sun(light, u);
  case LightKind::Area:
    return sample_area(light, p, u);
  }
  return {};
}

LightHit meet(const Light &light, const glm::dvec3 &o, const glm::dvec3 &wi) {
  switch (light.kind) {
  case LightKind::Point:
  case LightKind::Spot:
    return meet_point(light, o, wi);
  case LightKind::Sun:
    return meet_sun(light, wi);
  case LightKind::Area:
    return meet_area(light, o, wi);
  }
  return {};
}

bool has_extent(const Light &light) {
  if (light.kind == LightKind::Sun)
    return light.one_minus_cos_sun > 0.0;
  return light.kind == LightKind::Area ? light.area > 0.0 : light.radius > 0.0;
}

} // namespace lancer
