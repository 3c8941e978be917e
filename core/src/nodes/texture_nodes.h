// Nodes of textures, tables, objects and rays. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/curves.h"
#include "nodes/gabor.h"
#include "nodes/ies.h"
#include "nodes/noise.h"
#include "nodes/patterns.h"
#include "nodes/radial_tiling.h"
#include "nodes/site.h"
#include "nodes/voronoi.h"
#include "sampling/elementary.h"
#include "scene/enums.h"
#include "simd/vectors.h"

namespace lancer {

// The Gradient Texture: a ramp from 0 to 1 along, around or away from an axis.
// kind: GradientKind.
template <class F> LANCER_LANE F gradient_texture(uint32_t kind, const Vector3<F> &p) {
  const F zero(0.0f), one(1.0f);
  F value = p.x;
  switch (kind) {
  case GradientKind::Linear:
    break;
  case GradientKind::Quadratic:
    value = max(zero, p.x) * max(zero, p.x);
    break;
  case GradientKind::Easing: {
    const F r = min(one, max(zero, p.x)), square = r * r;
    value = F(3.0f) * square - F(2.0f) * square * r;
    break;
  }
  case GradientKind::Diagonal:
    value = (p.x + p.y) * F(0.5f);
    break;
  case GradientKind::Radial:
    value = narrow(angle(widen(p.y), widen(p.x)) * DoubleOf<F>(0.15915494309189535)) + F(0.5f);
    break;
  default: {
    // Slightly below 1, so that unit vectors give 0 despite rounding.
    const F r = max(zero, F(0.999999f) - sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
    value = kind == GradientKind::QuadraticSphere ? r * r : r;
  }
  }
  return min(one, max(zero, value));
}

namespace {

template <class F> Value<F> noise_node(const Inputs<F> &in) {
  return solid(noise_texture<F>(in.node.option, in.node.flags, in[0], in[1], in[2], in[3]));
}

template <class F> Value<F> voronoi_node(const Inputs<F> &in) {
  const VoronoiValue<F> value = voronoi_texture<F>(in.node.option, in.node.flags, in[0], in[1], in[2], in[3]);
  return {value.vector, value.number};
}

template <class F> Value<F> gradient_node(const Inputs<F> &in) { return scalar(gradient_texture<F>(in.node.option, in[0])); }

template <class F> Value<F> wave_node(const Inputs<F> &in) {
  return scalar(wave_texture<F>(in.node.option, in.node.flags, in[0], in[1], in[2]));
}

template <class F> Value<F> magic_node(const Inputs<F> &in) {
  return solid(magic_texture<F>(in.node.option, in.node.flags & 1, in[0], in[1]));
}

template <class F> Value<F> checker_node(const Inputs<F> &in) { return scalar(checker_texture<F>(in[0], in.scalar(1))); }

template <class F> Value<F> brick_node(const Inputs<F> &in) {
  const BrickShares<F> shares = brick_texture<F>(in[0], in[1], in[2], in[3], in[4]);
  return solid(Vector3<F>(shares.second, shares.mortar, F(0.0f)));
}

template <class F> Value<F> white_noise_node(const Inputs<F> &in) {
  return solid(white_noise_texture<F>(in.node.flags, in[0], in.scalar(1)));
}

template <class F> Value<F> gabor_node(const Inputs<F> &in) {
  return solid(gabor_texture<F>(in.node.option == 1, in[0], in[1], in.node.option == 1 ? unit_or_zero(in[2]) : in[2]));
}

template <class F> Value<F> radial_tiling_node(const Inputs<F> &in) {
  const Vector3<F> p = in[0], shape = in[1];
  if (in.node.option == 1)
    return scalar(radial_segment<F>(p.x, p.y, shape.x));
  const Tile<F> tile = radial_tile<F>(p.x, p.y, shape.x, shape.y, in.node.flags & 1);
  return {{tile.along, tile.distance, tile.width}, tile.turn};
}

template <class F> Value<F> ies_node(const Inputs<F> &in) {
  const ImageView &image = in.images[in.node.image];
  const IesTable table{reinterpret_cast<const float *>(image.texels), image.width, image.height};
  return scalar(F(in.scalar(1) * ies_texture<F>(table, in[0])));
}

template <class F> Value<F> curves_node(const Inputs<F> &in) {
  const ImageView &image = in.images[in.node.image];
  const CurveTable table{reinterpret_cast<const float *>(image.texels),
                         image.width,
                         image.channels,
                         in.node.matrix[0],
                         in.node.matrix[1],
                         (in.node.flags & 1) != 0,
                         (in.node.flags & 2) == 0};
  if (in.node.option == 0)
    return solid(on_curves<F>(table, in.scalar(0), in[1]));
  const F x = in.scalar(1);
  const uint32_t step = image.channels < 3 ? 0 : 1;
  const Vector3<F> color{on_curve(table, 0, x), on_curve(table, step, x), on_curve(table, 2 * step, x)};
  return {color, image.channels == 4 ? on_curve(table, 3, x) : F(1.0f)};
}

// A named value of the object; 0 without one.
template <class F> Value<F> object_attribute(const Node &node, const Site<F> &site) {
  for (const ObjectAttributeView &attribute : site.scene.geometry->object_attributes) {
    if (attribute.name != node.name)
      continue;
    const auto channel = [&](int k) __attribute__((always_inline)) {
      return by_lane<F>([&](int i) {
        const uint32_t at = site.instance[i]->number;
        return at < attribute.values.size() ? attribute.values[at][k] : 0.0f;
      });
    };
    return {{channel(0), channel(1), channel(2)}, channel(3)};
  }
  return nothing<F>();
}

// The Object Info node: location, and data that distinguish objects.
template <class F> Value<F> object_info_node(const Node &node, const Site<F> &site) {
  using D = DoubleOf<F>;
  if (!site.placed)
    return node.option == ObjectFact::Attribute ? solid(Vector3<F>(F(0.0f))) : nothing<F>();
  if (node.option == ObjectFact::Location) {
    const Vector3<D> origin = translation_of(site, &Instance::to_world);
    return solid(narrow(in_user_world(site, origin)));
  }
  if (node.option == ObjectFact::Index)
    return scalar(by_lane<F>([&](int i) { return static_cast<float>(site.instance[i]->object_index); }));
  if (node.option == ObjectFact::Attribute)
    return object_attribute(node, site);
  const std::span<const ObjectInfo> all = site.scene.geometry->object_infos;
  const auto number = [&](auto which) __attribute__((always_inline)) {
    return by_lane<F>([&](int i) {
      const uint32_t at = site.instance[i]->number;
      return at < all.size() ? which(all.data()[at]) : which(ObjectInfo());
    });
  };
  if (node.option != ObjectFact::Color)
    return scalar(number([](const ObjectInfo &info) { return info.random; }));
  const auto channel = [&](int k) { return number([k](const ObjectInfo &info) { return (&info.color.x)[k]; }); };
  return {{channel(0), channel(1), channel(2)}, channel(3)};
}

template <class F> Value<F> light_path_node(const Node &node, const Site<F> &site) {
  return scalar(light_path_value(node.option, site.path));
}

} // namespace

} // namespace lancer
