#include "lights/suns.h"

#include "nodes/run.h"

namespace lancer {

namespace {

// Directions in which a rotation is checked: none is along an axis or in a plane of two.
constexpr glm::dvec3 kChecks[] = {{0.48, 0.6, 0.64}, {-0.64, 0.48, -0.6}, {0.36, -0.48, 0.8}, {-0.8, -0.36, 0.48}};
// Nodes compute in single precision, in a few steps; the disc is enlarged by more than this error.
constexpr double kRotationError = 4e-6;

// Returns the vector that a node reads in a direction.
glm::dvec3 vector_at(const WorldView &world, const NodeScene &scene, const Node &node, const glm::dvec3 &direction,
                     std::vector<glm::vec4> &values) {
  NodeContext context;
  static_cast<NodeScene &>(context) = scene;
  context.wo = glm::vec3(-direction);
  run(world.program, world.schedule, context, values);
  return glm::dvec3(value_of(node.inputs[0], values));
}

} // namespace

std::vector<Sun> find_suns(const WorldView &world, const NodeScene &scene) {
  std::vector<Sun> suns;
  std::vector<glm::vec4> values(world.program.value_count());
  for (const uint16_t number : world.schedule) {
    const Node &node = world.program.nodes[number];
    if (node.kind != NodeKind::Sky || node.option <= SkyModel::HosekWilkie || !(node.matrix[9] > 0.0f) ||
        !node.inputs[0].varies())
      continue;
    const auto at = [&](const glm::dvec3 &direction) { return vector_at(world, scene, node, direction, values); };
    const glm::dmat3 map(at({1.0, 0.0, 0.0}), at({0.0, 1.0, 0.0}), at({0.0, 0.0, 1.0}));
    const glm::dmat3 round = glm::transpose(map) * map;
    double error = 0.0;
    for (int column = 0; column < 3; ++column)
      error = std::max(error, glm::length(round[column] - glm::dmat3(1.0)[column]));
    for (const glm::dvec3 &direction : kChecks)
      error = std::max(error, glm::length(map * direction - at(direction)));
    // Also false for numbers that are not finite.
    if (!(error < kRotationError))
      continue;
    const glm::dvec3 sun(double(node.matrix[6]), double(node.matrix[7]), double(node.matrix[8]));
    suns.push_back({glm::normalize(glm::transpose(map) * sun), 0.5 * double(node.matrix[9]) + kRotationError, number});
  }
  return suns;
}

std::vector<Node> without_suns(const WorldView &world, const std::vector<Sun> &suns) {
  std::vector<Node> nodes(world.program.nodes.begin(), world.program.nodes.end());
  for (const Sun &sun : suns)
    nodes[sun.node].matrix[9] = 0.0f;
  return nodes;
}

} // namespace lancer
