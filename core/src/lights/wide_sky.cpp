#include "lights/wide_sky.h"

#include "nodes/rotation.h"
#include "sampling/plain_vectors.h"
#include "scene/world.h"

namespace lancer {

namespace {

bool is_mapping(const Node &node) {
  return node.kind == LANCER_NODE_MAPPING && (node.option == LANCER_MAPPING_POINT || node.option == LANCER_MAPPING_VECTOR) &&
         !node.inputs[1].varies() && !node.inputs[2].varies() && !node.inputs[3].varies();
}

bool is_direction(const Node &node) {
  return node.kind == LANCER_NODE_COORDINATE &&
         (node.option == LANCER_COORDINATE_GENERATED || node.option == LANCER_COORDINATE_POSITION);
}

// A picture of all directions, mapped or not, times a constant or not.
bool add_picture(const World &world, const std::vector<Image> &images, WideSky &sky) {
  const Node *node = world.program.source(world.radiance);
  if (node && node->kind == LANCER_NODE_VECTOR_MATH && node->option == LANCER_VECTOR_MULTIPLY &&
      node->inputs[0].varies() != node->inputs[1].varies()) {
    const int varying = node->inputs[0].varies() ? 0 : 1;
    sky.multiplied = 1;
    copy(node->inputs[1 - varying].value, sky.factor);
    node = world.program.source(node->inputs[varying]);
  }
  if (!node || node->kind != LANCER_NODE_ENVIRONMENT || node->option != LANCER_ENVIRONMENT_EQUIRECTANGULAR ||
      node->image_count == 0)
    return false;
  const WideImage image = wide_image(images[node->image], node->flags, false);
  node = world.program.source(node->inputs[0]);
  if (node && is_mapping(*node)) {
    sky.mapped = 1;
    const glm::mat3 turn = rotation(node->inputs[2].value);
    for (int column = 0; column < 3; ++column)
      copy(turn[column], sky.turn[column]);
    copy(node->inputs[3].value, sky.scale);
    copy(node->option == LANCER_MAPPING_POINT ? node->inputs[1].value : glm::vec3(0.0f), sky.location);
    node = world.program.source(node->inputs[0]);
  }
  if (!node || !is_direction(*node))
    return false;
  sky.image = image;
  return true;
}

} // namespace

WideSky make_wide_sky(const World &world, const std::vector<Image> &images, const DirectionMap &map) {
  WideSky sky;
  if (!add_picture(world, images, sky))
    sky = {};
  sky.map = map.table();
  return sky;
}

} // namespace lancer
