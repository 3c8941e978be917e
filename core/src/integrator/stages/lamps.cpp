#include "integrator/stages/lamps.h"

#include <algorithm>
#include <bit>

namespace lancer {

namespace {

size_t most_nodes_of(const LampShaders &shaders) {
  size_t most = 0;
  for (const LampShader &shader : shaders.of)
    most = std::max(most, shader.program.value_count());
  return most;
}

} // namespace

LampStage::LampStage(const Scene &scene, const Camera *camera)
    : shaders_(scene.lamp_shaders), normalisation_(scene.normalisation), values_(most_nodes_of(scene.lamp_shaders)) {
  block_.scene = scene.node_scene(camera);
  block_.scene.geometry = &shaders_.frames;
}

void LampStage::set(uint32_t lane, const Light &light, const glm::dvec3 &target, const glm::dvec3 &wi, double distance,
                    LightPath<float> path) {
  const LampPoint point = lamp_point(light, shaders_, target, wi, distance, normalisation_);
  block_.instance[lane] = light.shader;
  put(point.p, block_.p, lane);
  put(point.n, block_.ns, lane);
  put(point.n, block_.ng, lane);
  put(point.wo, block_.wo, lane);
  for (int i = 0; i < 2; ++i)
    block_.bary[i][lane] = point.bary[i];
  path.length = point.length;
  put(path, block_, lane);
}

void LampStage::look(uint32_t lanes) {
  while (lanes != 0) {
    // Take the lanes that have the lamp of the first.
    const uint32_t number = block_.instance[std::countr_zero(lanes)];
    block_.used = 0;
    for (uint32_t rest = lanes; rest != 0; rest &= rest - 1)
      if (const int lane = std::countr_zero(rest); block_.instance[lane] == number)
        block_.used |= 1u << lane;
    const LampShader &shader = shaders_.of[number];
    node_kernel().run(shader.program, shader.schedule, block_, values_.data());
    const NodeLanes &value = values_[size_t(shader.strength.node)];
    for (uint32_t rest = block_.used; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      strength_[lane] = {value.of[0][lane], value.of[1][lane], value.of[2][lane]};
    }
    lanes &= ~block_.used;
  }
}

} // namespace lancer
