// Runs scheduled nodes in order and maps each kind to its formula. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/bump_node.h"
#include "nodes/color_nodes.h"
#include "nodes/image_nodes.h"
#include "nodes/texture_nodes.h"

namespace lancer {
namespace {

// Returns the value of one node at a site.
template <class F> Value<F> node_value(const Program &program, const Inputs<F> &in, const Site<F> &site) {
  const Node &node = in.node;
  switch (node.kind) {
  case LANCER_NODE_COORDINATE:
    return coordinate_node(node, site);
  case LANCER_NODE_ATTRIBUTE:
    return attribute_node(node, node.flags & LANCER_ATTRIBUTE_STILL ? site.standing() : site);
  case LANCER_NODE_IMAGE:
    return image_node(in, site);
  case LANCER_NODE_ENVIRONMENT:
    return environment_node(in, site);
  case LANCER_NODE_ALPHA:
    return scalar(in.alpha(0));
  case LANCER_NODE_MAPPING:
    return mapping_node(in);
  case LANCER_NODE_TRANSFORM:
    return transform_node(in);
  case LANCER_NODE_MATH:
    return math_node(in);
  case LANCER_NODE_VECTOR_MATH:
    return vector_math_node(in);
  case LANCER_NODE_MIX:
    return mix_node(in);
  case LANCER_NODE_SEPARATE:
    return separate_node(in);
  case LANCER_NODE_COMBINE:
    return combine_node(in);
  case LANCER_NODE_GREY:
    return grey_node(in);
  case LANCER_NODE_FRESNEL:
    return fresnel_node(in, site);
  case LANCER_NODE_LAYER_WEIGHT:
    return layer_weight_node(in, site);
  case LANCER_NODE_NORMAL_MAP:
    return normal_map_node(in, site.standing());
  case LANCER_NODE_BUMP:
    return bump_node(program, in, site);
  case LANCER_NODE_TANGENT:
    return tangent_node(in, site.standing());
  case LANCER_NODE_CLAMP:
    return clamp_node(in);
  case LANCER_NODE_DISPLACEMENT:
    return displacement_node(in, site);
  case LANCER_NODE_GAMMA:
    return gamma_node(in);
  case LANCER_NODE_INVERT:
    return invert_node(in);
  case LANCER_NODE_COLOR_MODEL:
    return color_model_node(in);
  case LANCER_NODE_NOISE:
    return noise_node(in);
  case LANCER_NODE_VORONOI:
    return voronoi_node(in);
  case LANCER_NODE_GRADIENT:
    return gradient_node(in);
  case LANCER_NODE_CURVES:
    return curves_node(in, site);
  case LANCER_NODE_OBJECT_INFO:
    return object_info_node(node, site);
  case LANCER_NODE_LIGHT_PATH:
    return light_path_node(node, site);
  default:
    return nothing<F>();
  }
}

template <class F>
void run_nodes(const Program &program, const Schedule &schedule, const Site<F> &site, const Values<F> &values) {
  for (const uint16_t number : schedule)
    values.set(number, node_value(program, Inputs<F>{program.nodes[number], values}, site));
}

} // namespace
} // namespace lancer
