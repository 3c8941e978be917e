// Checks and copies the world.
#include "scene/description.h"
#include "scene/error.h"
#include "scene/fill.h"

#include <cmath>

namespace lancer {

void set_world(Description &description, const lancer_world &source) {
  constexpr uint32_t widest = 1u << 16;
  if (source.map_resolution > widest)
    bad_argument("world: map resolution " + std::to_string(source.map_resolution) + " is above " + std::to_string(widest));
  check_rays("world", source.hidden_from);
  World world;
  world.program = read_program(description, "world", source.nodes, source.node_count);
  check_reference("world", "radiance", source.radiance, world.program);
  for (int i = 0; i < 3; ++i) {
    const float value = source.radiance.value[i];
    if (source.radiance.node < 0 && (!std::isfinite(value) || value < 0.0f))
      bad_argument("world: radiance " + to_text(value) + " must be finite and not negative");
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
  description.world = std::move(world);
}

} // namespace lancer
