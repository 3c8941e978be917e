// Runs scheduled nodes in order, at one hit or in the lanes of a block, and maps each kind to its formula. Internal linkage, as
// in lanes.h.
#pragma once

#include "nodes/bump_node.h"
#include "nodes/color_nodes.h"
#include "nodes/image_nodes.h"
#include "nodes/looking_nodes.h"
#include "nodes/place_nodes.h"
#include "nodes/sky.h"
#include "nodes/texture_nodes.h"
#include "nodes/voxels.h"

#include <bit>

namespace lancer {

namespace {

inline uint32_t number_of(const ProgramView &program, const Node &node) { return uint32_t(&node - program.nodes.data()); }

// Returns the value of one node at a site.
template <class F> Value<F> node_value(const ProgramView &program, const Inputs<F> &in, const Site<F> &site) {
  const Node &node = in.node;
  switch (node.kind) {
  case NodeKind::Coordinate:
    return coordinate_node(node, site);
  case NodeKind::Attribute:
    return attribute_node(node, node.flags & AttributeFlag::Still ? site.standing() : site);
  case NodeKind::Image:
    return image_node(program, in, site);
  case NodeKind::Environment:
    return environment_node(program, in, site);
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
  case NodeKind::Wave:
    return wave_node(in);
  case NodeKind::Magic:
    return magic_node(in);
  case NodeKind::Checker:
    return checker_node(in);
  case NodeKind::Brick:
    return brick_node(in);
  case NodeKind::WhiteNoise:
    return white_noise_node(in);
  case NodeKind::Gabor:
    return gabor_node(in);
  case NodeKind::RadialTiling:
    return radial_tiling_node(in);
  case NodeKind::Wireframe:
    return wireframe_node(in, site);
  case NodeKind::VectorTransform:
    return vector_transform_node(in, site);
  case NodeKind::Ies:
    return ies_node(in);
  case NodeKind::Curves:
    return curves_node(in);
  case NodeKind::Sky:
    return sky_node(in);
  case NodeKind::Occlusion:
    return occlusion_node(in, site.standing(), number_of(program, node));
  case NodeKind::Bevel:
    return bevel_node(in, site.standing(), number_of(program, node));
  case NodeKind::Raycast:
    return raycast_node(in, site);
  case NodeKind::Voxels:
    return voxels_node(in);
  case NodeKind::ObjectInfo:
    return object_info_node(node, site);
  case NodeKind::LightPath:
    return light_path_node(node, site);
  default:
    return nothing<F>();
  }
}

template <class F>
void run_nodes(const ProgramView &program, ScheduleView schedule, const Site<F> &site, const Values<F> &values) {
  for (const uint16_t number : schedule) {
    const Node &node = program.nodes[number];
    const Inputs<F> in{node, values, program.images.data()};
    values.set(number, node_value(program, in, site));
    if (node.changes < 0)
      continue;
    const Change<F> change = node_change(program, in, site);
    values.set(size_t(node.changes), solid(change.x));
    values.set(size_t(node.changes) + 1, solid(change.y));
  }
}

} // namespace

namespace {

// Returns the site of the lanes from first on. Unused lanes copy a used one.
template <class F> Site<F> site_of(const NodeBlock &block, int first) {
  constexpr int width = Site<F>::kWidth;
  using D = DoubleOf<F>;
  const auto floats = [&](const float(&from)[kBlockLanes]) __attribute__((always_inline)) {
    return load_lanes<width>(from + first);
  };
  const auto doubles = [&](const double(&from)[kBlockLanes]) __attribute__((always_inline)) {
    return load_lanes<width>(from + first);
  };
  Site<F> site;
  site.scene = block.scene;
  site.looking = block.looking;
  site.first = first;
  site.surface = block.surface;
  const int stand_in = std::countr_zero(block.used >> first);
  for (int i = 0; i < width; ++i) {
    const int from = first + ((block.used >> (first + i) & 1) ? i : stand_in);
    site.primitive[i] = block.surface ? block.primitive[from] : 0;
    site.number[i] = block.surface ? block.instance[from] : kNone;
    site.instance[i] = block.surface && block.scene.geometry ? &block.scene.geometry->instances[block.instance[from]] : nullptr;
    if (block.surface && block.moved && block.moved->instance[from])
      site.instance[i] = block.moved->instance[from];
    site.time[i] = block.moved ? block.moved->time[from] : kMiddleTime;
    site.eye[i] = block.surface ? nullptr : block.eye[from];
  }
  site.place();
  site.p = {doubles(block.p[0]), doubles(block.p[1]), doubles(block.p[2])};
  site.ns = {floats(block.ns[0]), floats(block.ns[1]), floats(block.ns[2])};
  site.ng = {floats(block.ng[0]), floats(block.ng[1]), floats(block.ng[2])};
  site.wo = {floats(block.wo[0]), floats(block.wo[1]), floats(block.wo[2])};
  site.bary[0] = block.surface ? doubles(block.bary[0]) : D(0.0);
  site.bary[1] = block.surface ? doubles(block.bary[1]) : D(0.0);
  site.footprint = block.surface ? floats(block.footprint) : F(0.0f);
  const uint32_t seen_from_behind = block.surface ? block.backfacing >> first : 0;
  site.backfacing = by_lane<MaskOf<F>>([&](int i) { return (seen_from_behind >> i & 1) != 0; });
  site.path.kinds = load_lanes<width>(block.kinds + first);
  site.path.length = floats(block.length);
  site.path.depth = floats(block.depth);
  site.path.diffuse = floats(block.diffuse);
  site.path.glossy = floats(block.glossy);
  site.path.transmission = floats(block.transmission);
  site.path.transparent = floats(block.transparent);
  site.path.portal = floats(block.portal);
  site.path.width = floats(block.width);
  site.path.spread = floats(block.spread);
  return site;
}

template <class F>
void run_block(const ProgramView &program, ScheduleView schedule, const NodeBlock &block, NodeLanes *values) {
  constexpr int width = Site<F>::kWidth;
  for (int first = 0; first < kBlockLanes; first += width)
    if (block.used >> first & ((1u << width) - 1u))
      run_nodes(program, schedule, site_of<F>(block, first), Values<F>{values->of[0] + first, kBlockLanes});
}

} // namespace

} // namespace lancer
