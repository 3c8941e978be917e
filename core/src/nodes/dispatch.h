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
  case NodeKind::Coordinate:
    return coordinate_node(node, site);
  case NodeKind::Attribute:
    return attribute_node(node, node.flags & AttributeFlag::Still ? site.standing() : site);
  case NodeKind::Image:
    return image_node(in, site);
  case NodeKind::Environment:
    return environment_node(in, site);
  case NodeKind::Alpha:
    return scalar(in.alpha(0));
  case NodeKind::Mapping:
    return mapping_node(in);
  case NodeKind::Transform:
    return transform_node(in);
  case NodeKind::Math:
    return math_node(in);
  case NodeKind::VectorMath:
    return vector_math_node(in);
  case NodeKind::Mix:
    return mix_node(in);
  case NodeKind::Separate:
    return separate_node(in);
  case NodeKind::Combine:
    return combine_node(in);
  case NodeKind::Grey:
    return grey_node(in);
  case NodeKind::Fresnel:
    return fresnel_node(in, site);
  case NodeKind::LayerWeight:
    return layer_weight_node(in, site);
  case NodeKind::NormalMap:
    return normal_map_node(in, site.standing());
  case NodeKind::Bump:
    return bump_node(program, in, site);
  case NodeKind::Tangent:
    return tangent_node(in, site.standing());
  case NodeKind::Clamp:
    return clamp_node(in);
  case NodeKind::Displacement:
    return displacement_node(in, site);
  case NodeKind::Gamma:
    return gamma_node(in);
  case NodeKind::Invert:
    return invert_node(in);
  case NodeKind::ColorModel:
    return color_model_node(in);
  case NodeKind::Noise:
    return noise_node(in);
  case NodeKind::Voronoi:
    return voronoi_node(in);
  case NodeKind::Gradient:
    return gradient_node(in);
  case NodeKind::Curves:
    return curves_node(in, site);
  case NodeKind::ObjectInfo:
    return object_info_node(node, site);
  case NodeKind::LightPath:
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
