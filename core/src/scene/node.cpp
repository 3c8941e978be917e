// Which nodes are needed, and running them in order.
#include "scene/node.h"

#include "scene/node_site.h"

namespace lancer {

namespace {

void mark(const Parameter &parameter, std::vector<bool> &needed) {
  if (parameter.varies())
    needed[size_t(parameter.node)] = true;
}

} // namespace

Schedule Program::schedule(std::span<const Parameter> parameters) const {
  std::vector<bool> needed(nodes.size());
  for (const Parameter &parameter : parameters)
    mark(parameter, needed);
  // Nodes refer to earlier ones only: one pass backwards meets every user before what it uses.
  for (size_t i = nodes.size(); i-- > 0;) {
    if (!needed[i])
      continue;
    const Node &node = nodes[i];
    for (int k = 0; k < 5; ++k) {
      const bool height = node.kind == LANCER_NODE_BUMP && k == 2;
      if (!height || node.inputs[k].node < int32_t(node.first))
        mark(node.inputs[k], needed);
    }
    if (node.kind != LANCER_NODE_BUMP)
      continue;
    // A bump runs its own nodes; what those take from before them is needed here.
    for (const uint16_t number : heights[node.heights]) {
      const Node &inner = nodes[number];
      for (int k = 0; k < 5; ++k)
        if (is_read_in_height(inner, k) && inner.inputs[k].node < int32_t(node.first))
          mark(inner.inputs[k], needed);
    }
  }
  Schedule result;
  for (size_t i = 0; i < nodes.size(); ++i)
    if (needed[i])
      result.push_back(uint16_t(i));
  return result;
}

void run_at(const Program &program, const Schedule &schedule, const Site &site, std::span<glm::vec4> values) {
  for (const uint16_t number : schedule) {
    const Node &node = program.nodes[number];
    const Inputs in{node, values};
    glm::vec4 &result = values[number];
    switch (node.kind) {
    case LANCER_NODE_COORDINATE:
      result = coordinate(node, site);
      break;
    case LANCER_NODE_ATTRIBUTE:
      result = attribute(node, site);
      break;
    case LANCER_NODE_IMAGE:
      result = image(in, site);
      break;
    case LANCER_NODE_ENVIRONMENT:
      result = environment(in, site);
      break;
    case LANCER_NODE_ALPHA:
      result = scalar(in.alpha(0));
      break;
    case LANCER_NODE_MAPPING:
      result = mapping(in);
      break;
    case LANCER_NODE_TRANSFORM:
      result = transform(in);
      break;
    case LANCER_NODE_MATH: {
      const float value = math(node.option, in.scalar(0), in.scalar(1), in.scalar(2));
      result = scalar(node.flags & 1 ? glm::clamp(value, 0.0f, 1.0f) : value);
      break;
    }
    case LANCER_NODE_VECTOR_MATH:
      result = vector_math(in);
      break;
    case LANCER_NODE_MIX:
      result = mix(in);
      break;
    case LANCER_NODE_SEPARATE:
      result = scalar(in[0][int(node.option)]);
      break;
    case LANCER_NODE_COMBINE:
      result = {in.scalar(0), in.scalar(1), in.scalar(2), 1.0f};
      break;
    case LANCER_NODE_GREY:
      result = scalar(glm::dot(in[0], glm::vec3(node.matrix[0], node.matrix[1], node.matrix[2])));
      break;
    case LANCER_NODE_FRESNEL:
      result = scalar(fresnel_weight(in, site));
      break;
    case LANCER_NODE_LAYER_WEIGHT:
      result = scalar(layer_weight(in, site));
      break;
    case LANCER_NODE_NORMAL_MAP:
      result = solid(normal_map(in, site));
      break;
    case LANCER_NODE_BUMP:
      result = solid(bump(program, in, site, values));
      break;
    case LANCER_NODE_TANGENT:
      result = solid(tangent(node, site));
      break;
    case LANCER_NODE_CLAMP:
      result = scalar(std::min(std::max(in.scalar(0), in.scalar(1)), in.scalar(2)));
      break;
    case LANCER_NODE_DISPLACEMENT:
      result = solid(displacement(in, site));
      break;
    case LANCER_NODE_GAMMA:
      result = gamma(in);
      break;
    case LANCER_NODE_INVERT: {
      const float factor = in.scalar(0);
      result = solid(factor * (1.0f - in[1]) + (1.0f - factor) * in[1]);
      break;
    }
    case LANCER_NODE_NOISE:
      result = noise(in);
      break;
    case LANCER_NODE_VORONOI:
      result = voronoi(in);
      break;
    case LANCER_NODE_GRADIENT:
      result = gradient(in);
      break;
    case LANCER_NODE_CURVES:
      result = curves(in, site);
      break;
    case LANCER_NODE_OBJECT_INFO:
      result = object_info(node, site);
      break;
    case LANCER_NODE_LIGHT_PATH:
      result = scalar(light_path_value(node.option, site.context->path));
      break;
    default:
      result = glm::vec4(0.0f);
    }
  }
}

void run(const Program &program, const Schedule &schedule, const NodeContext &context, std::span<glm::vec4> values) {
  run_at(program, schedule, Site(context), values);
}

} // namespace lancer
