// The shaders of lamps with nodes, and the frames in which these nodes read places.
#include "compile/steps.h"

#include <cmath>

namespace lancer {

namespace {

// Returns the frame of a lamp. A lamp whose matrix is singular, as one without depth, has that of its axes.
Affine frame_of(const LightDescription &from, const Light &light, const Normalisation &normalisation) {
  const Affine map = normalisation.to_normalised(from.to_world);
  if (!is_singular(map.linear))
    return map;
  return {normalisation.scale * glm::dmat3(light.x, light.y, light.z), map.translation};
}

} // namespace

void add_lamp_shader(const LightDescription &from, Light &light, const Normalisation &normalisation, LampShaders &shaders) {
  if (!from.strength.varies())
    return;
  light.shader = uint32_t(shaders.of.size());
  Instance frame;
  // Nodes find neither meshes nor attributes there.
  frame.kind = ShapeKind::Plane;
  frame.number = light.shader;
  frame.place(frame_of(from, light, normalisation));
  shaders.places.push_back(frame);
  shaders.frames.instances = shaders.places;
  LampShader shader;
  shader.program = from.program;
  shader.strength = from.strength;
  shader.schedule = from.schedule;
  if (light.kind == LightKind::Area) {
    // Along the columns of the matrix, which need not be orthogonal.
    const double scale = normalisation.scale;
    shader.across = unit_or_zero(from.to_world.linear[0]) / std::max(double(from.size.x) * scale, 1e-300);
    shader.up = unit_or_zero(from.to_world.linear[1]) / std::max(double(from.size.y) * scale, 1e-300);
  } else if (light.kind == LightKind::Sun) {
    const glm::dmat3 rows = glm::transpose(frame.to_object.linear) * normalisation.scale;
    shader.across = rows[0];
    shader.up = rows[1];
    shader.inverse_sine = from.sun_angle > 0.0f ? 0.5 / sin(0.25 * double(from.sun_angle)) : 0.0;
  } else if (light.kind == LightKind::Spot) {
    const double half = 0.5 * double(from.spot_angle);
    shader.cotangent = 0.5 * cos(half) / std::max(sin(half), 1e-300);
  }
  shaders.of.push_back(shader);
}

} // namespace lancer
