#include "lights/lamp_shader.h"

#include "sampling/elementary.h"
#include "sampling/warp.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lancer {

namespace {

// Places looked at along each of two numbers, and the least weight.
constexpr int kLooks = 16;
constexpr double kLeast = 0.01;

// Returns the place on a lamp's own picture, 0 ... 1. n: as LampPoint::n.
glm::dvec2 lamp_uv(const Light &light, const LampShader &shader, const Instance &frame, const glm::dvec3 &p,
                   const glm::dvec3 &n, const glm::dvec3 &wi) {
  switch (light.kind) {
  case LightKind::Area: {
    const glm::dvec3 from_middle = p - light.position;
    const glm::dvec2 place(glm::dot(from_middle, shader.across), glm::dot(from_middle, shader.up));
    return glm::clamp(place, -0.5, 0.5) + 0.5;
  }
  case LightKind::Sun: {
    // The directions of the disk, mapped to a disk so that equal solid angles have equal areas.
    const double scale = shader.inverse_sine / glm::length(wi + light.z);
    return {0.5 + glm::dot(wi, shader.across) * scale, 0.5 + glm::dot(wi, shader.up) * scale};
  }
  case LightKind::Spot: {
    const glm::dvec3 away = frame.to_object.vector(-wi);
    const double scale = shader.cotangent / -away.z;
    return {0.5 + away.x * scale, 0.5 + away.y * scale};
  }
  default: {
    const glm::dvec3 out = frame.to_object.vector(n);
    const double across = std::sqrt(out.x * out.x + out.y * out.y);
    if (!(glm::dot(out, out) > 0.0))
      return glm::dvec2(0.0);
    const double turns = across > 0.0 ? 0.5 - angle(out.x, out.y) * 0.15915494309189535 : 0.0;
    return {turns, 0.5 + angle(out.z, across) * 0.3183098861837907};
  }
  }
}

} // namespace

LampPoint lamp_point(const Light &light, const LampShaders &shaders, const glm::dvec3 &target, const glm::dvec3 &wi,
                     double distance, const Normalisation &normalisation) {
  LampPoint point;
  const bool far = light.kind == LightKind::Sun;
  // The position of a sun is the direction of its light.
  point.p = far ? normalisation.to_normalised(-wi) : target;
  point.wo = glm::vec3(-wi);
  glm::dvec3 n = -wi;
  if (light.kind == LightKind::Area)
    n = -light.z;
  else if (!far && !light.soft_falloff && light.radius > 0.0)
    n = unit_or_zero(target - light.position);
  point.n = glm::vec3(glm::dot(n, wi) > 0.0 ? -n : n);
  const glm::dvec2 uv = lamp_uv(light, shaders.of[light.shader], shaders.frames.instances[light.shader], point.p, n, wi);
  point.bary = {uv.y, 1.0 - uv.x - uv.y};
  point.length = far ? std::numeric_limits<float>::max() : float(distance / normalisation.scale);
  return point;
}

double mean_strength(const Light &light, const LampShaders &shaders, const NodeScene &scene) {
  const LampShader &shader = shaders.of[light.shader];
  const Normalisation plain, &normalisation = scene.normalisation ? *scene.normalisation : plain;
  std::vector<glm::vec4> values(shader.program.value_count());
  NodeContext context;
  static_cast<NodeScene &>(context) = scene;
  context.geometry = &shaders.frames;
  // Cosine of half the cone of directions around the axis.
  const double cosine = light.kind == LightKind::Point  ? -1.0
                        : light.kind == LightKind::Spot ? std::max(light.cos_half_angle, 0.0)
                        : light.kind == LightKind::Sun  ? 1.0 - light.one_minus_cos_sun
                                                        : 0.0;
  double sum = 0.0;
  for (int look = 0; look < kLooks * kLooks; ++look) {
    const double u = (look % kLooks + 0.5) / kLooks, v = (look / kLooks + 0.5) / kLooks;
    const double z = 1.0 - u * (1.0 - cosine), across = std::sqrt(std::max(0.0, 1.0 - z * z));
    const SinCos<double> turn = sin_cos_turn(v);
    const glm::dvec3 side = across * (turn.cos * light.x + turn.sin * light.y);
    // A sun's light comes from its axis z; other lamps shine along -z.
    const glm::dvec3 wi = light.kind == LightKind::Sun ? z * light.z + side : z * light.z - side;
    glm::dvec3 target = light.position;
    if (light.kind == LightKind::Area)
      target += (2.0 * u - 1.0) * light.half_x * light.x + (2.0 * v - 1.0) * light.half_y * light.y;
    else if (!light.soft_falloff)
      target -= light.radius * wi;
    const LampPoint point = lamp_point(light, shaders, target, wi, 1.0, normalisation);
    Surface surface;
    surface.p = point.p;
    surface.ng = surface.ns = point.n;
    surface.bary = point.bary;
    surface.instance = light.shader;
    surface.primitive = 0;
    context.surface = &surface;
    context.wo = point.wo;
    context.path = {.length = point.length, .depth = 1.0f};
    run(shader.program, shader.schedule, context, values);
    const double level = double(mean(glm::abs(value_of(shader.strength, values))));
    sum += std::isfinite(level) ? level : 0.0;
  }
  return std::max(sum / (kLooks * kLooks), kLeast);
}

} // namespace lancer
