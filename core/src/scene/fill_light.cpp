// Checks and copies lights and the world.
#include "sampling/elementary.h"
#include "scene/description.h"
#include "scene/fill.h"
#include "scene/messages.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lancer {

// Replaces invalid values of lights, with a message.
namespace {

// Largest finite radiance of a disk: a smaller lamp becomes a point, a smaller sun a direction.
constexpr double kBrightestDisk = 1e36;

double disk_radiance(const glm::vec3 &emission, double radius) {
  const glm::vec3 size = glm::abs(emission);
  return double(std::max({size.x, size.y, size.z})) / (glm::pi<double>() * radius * radius);
}

class LightReader {
public:
  LightReader(std::string object, Messages &messages) : object_(std::move(object)), messages_(messages) {}

  float read(const char *what, float value, float low, float high) {
    const float used = std::isnan(value) ? std::max(low, 0.0f) : std::clamp(value, low, high);
    if (!(value == used)) {
      messages_.add(object_, std::string(what) + " " + to_text(value) + " was replaced by " + to_text(used));
    }
    return used;
  }

  // Returns 0 if the radiance of a disk with this radius overflows float.
  float not_too_small(const char *what, float value, double radius, const glm::vec3 &emission) {
    if (!(radius > 0.0) || !(disk_radiance(emission, radius) > kBrightestDisk))
      return value;
    messages_.add(object_,
                  std::string(what) + " " + to_text(value) + " was replaced by 0: a lamp this small would be too bright");
    return 0.0f;
  }

  glm::vec3 read(const char *what, const float value[3], float low = 0.0f) {
    return {read(what, value[0], low, kBrightest), read(what, value[1], low, kBrightest),
            read(what, value[2], low, kBrightest)};
  }

private:
  std::string object_;
  Messages &messages_;
};

} // namespace

namespace {

// Returns the factor of a lamp's emission, which may be negative but must be finite.
Parameter read_strength(const std::string &object, const lancer_parameter &source, const Program &program) {
  check_reference(object, "strength", source, program);
  Parameter strength;
  strength.node = source.node;
  for (int i = 0; i < 3; ++i) {
    if (source.node < 0 && !std::isfinite(source.value[i]))
      bad_argument(object + ": strength " + to_text(source.value[i]) + " must be finite");
    strength.value[i] = source.value[i];
  }
  return strength;
}

} // namespace

LightDescription read_light(const lancer_light &source, size_t number, Images images, Messages &messages) {
  const std::string object = label("light", source.name, number);
  if (source.kind > LANCER_AREA)
    bad_argument(object + ": kind " + std::to_string(source.kind) + " is not a light");
  if (source.shape > LANCER_ELLIPSE)
    bad_argument(object + ": shape " + std::to_string(source.shape) + " is not one of 0, 1");
  if (source.falloff > LANCER_FALLOFF_GAUSSIAN)
    bad_argument(object + ": falloff " + std::to_string(source.falloff) + " is not one of 0 ... 5");
  if (source.opening != 0 && source.kind != LANCER_AREA)
    bad_argument(object + ": kind " + std::to_string(source.kind) + " is no opening, only an area is");
  check_rays(object, source.hidden_from);

  LightDescription light;
  light.name = source.name ? source.name : "";
  light.light_group = source.light_group;
  light.kind = static_cast<LightKind>(source.kind);
  light.opening = source.opening != 0;
  light.program = read_program(images, object, source.nodes, source.node_count);
  if (source.node_count)
    light.strength = read_strength(object, source.strength, light.program);
  light.schedule = light.program.schedule(std::span(&light.strength, 1));
  light.to_world = Affine::from_rows(source.matrix);
  if (!light.to_world.finite()) {
    messages.add(object, "its matrix is not finite; it gives no light");
    light.to_world = Affine{};
  } else {
    LightReader reader(object, messages);
    // A negative emission subtracts light.
    light.emission = reader.read("emission", source.emission, -kBrightest);
    light.radius = reader.read("radius", source.radius, 0.0f, kBrightest);
    if (light.kind == LightKind::Point || light.kind == LightKind::Spot)
      light.radius = reader.not_too_small("radius", light.radius, double(light.radius), light.emission);
    light.soft_falloff = source.soft_falloff != 0;
    light.spot_angle = reader.read("spot angle", source.spot_angle, 0.0f, glm::two_pi<float>());
    light.spot_blend = reader.read("spot blend", source.spot_blend, 0.0f, 1.0f);
    light.spot_cosine = source.spot_cosine != 0;
    light.sun_angle = reader.read("sun angle", source.sun_angle, 0.0f, glm::pi<float>());
    if (light.kind == LightKind::Sun)
      light.sun_angle = reader.not_too_small("sun angle", light.sun_angle, sin(0.5 * double(light.sun_angle)), light.emission);
    light.sun_flat = source.sun_flat != 0;
    // A spot needs a positive stretch; a size of 0, 0 means round.
    const float smallest = light.kind == LightKind::Spot ? 1e-6f : 0.0f;
    const bool round = light.kind == LightKind::Spot && source.size[0] == 0.0f && source.size[1] == 0.0f;
    light.size = round ? glm::vec2(1.0f)
                       : glm::vec2(reader.read("size", source.size[0], smallest, kBrightest),
                                   reader.read("size", source.size[1], smallest, kBrightest));
    light.shape = static_cast<AreaShape>(source.shape);
    light.spread = light.opening ? glm::pi<float>() : reader.read("spread", source.spread, 0.0f, glm::pi<float>());
    light.hidden_from = source.hidden_from;
    light.no_shadow = source.no_shadow != 0;
    light.no_catchers = source.no_catchers != 0;
    light.links = {source.unlit_sets, source.clear_sets};
    light.lit_surfaces = source.lit_surfaces;
    light.falloff = static_cast<Falloff>(source.falloff);
    light.falloff_radius = reader.read("falloff radius", source.falloff_radius, 0.0f, kBrightest);
    light.ambient_color = reader.read("ambient colour", source.ambient_color);
    light.diffuse_color = reader.read("diffuse colour", source.diffuse_color);
    light.specular_color = reader.read("specular colour", source.specular_color);
  }
  return light;
}

void add_light(Description &description, const lancer_light &source) {
  Messages messages;
  LightDescription light = read_light(source, description.lights.size(), description.images, messages);
  // Add a light without emission, too, so that lights have the numbers in which the caller adds them.
  description.lights.emplace_back(std::move(light), std::move(messages));
}

World read_world(const lancer_world &source, Images images) {
  constexpr uint32_t widest = 1u << 16;
  if (source.map_resolution > widest)
    bad_argument("world: map resolution " + std::to_string(source.map_resolution) + " is above " + std::to_string(widest));
  check_rays("world", source.hidden_from);
  World world;
  world.program = read_program(images, "world", source.nodes, source.node_count);
  check_reference("world", "radiance", source.radiance, world.program);
  for (int i = 0; i < 3; ++i) {
    const float value = source.radiance.value[i];
    if (source.radiance.node < 0 && !std::isfinite(value))
      bad_argument("world: radiance " + to_text(value) + " must be finite");
    world.radiance.value[i] = value;
  }
  if (source.use_ambient) {
    for (const float value : source.ambient)
      if (!std::isfinite(value) || value < 0.0f)
        bad_argument("world: ambient " + to_text(value) + " must be finite and not negative");
    world.ambient = glm::vec3(source.ambient[0], source.ambient[1], source.ambient[2]);
  }
  world.radiance.node = source.radiance.node;
  world.schedule = world.program.schedule(std::span(&world.radiance, 1));
  world.hidden_from = source.hidden_from;
  world.map_resolution = source.map_resolution;
  world.light_group = source.light_group;
  world.outputs = read_outputs("world", source.outputs, source.output_count, world.program);
  world.output_nodes = schedule_of(world.outputs, world.program);
  world.lit_surfaces = source.lit_surfaces;
  return world;
}

void set_world(Description &description, const lancer_world &source) {
  description.world = Given<World>(read_world(source, description.images));
}

} // namespace lancer
