// The Voronoi Texture: octaves of a feature of cells, as summed by Blender 4.0 and newer; one octave is the same in all
// versions.
#pragma once

#include "nodes/voronoi_cells.h"

namespace lancer {

template <class F> struct VoronoiOctaves { F scale, detail, roughness, lacunarity; };

// Outputs of the node: a vector (a colour, a position or one number three times) and a number.
template <class F> struct VoronoiValue {
  Vector3<F> vector;
  F number;
};

// Returns the weight of octave i: 1, the fraction of detail, or 0.
template <class F> LANCER_LANE F share_of_octave(int octave, const F &detail) {
  const F number(static_cast<float>(octave)), whole = floor(detail);
  return select(number <= detail, F(1.0f), select(number == whole + F(1.0f), detail - whole, F(0.0f)));
}

template <int N, class F>
static VoronoiValue<F> voronoi_octaves(uint32_t feature, uint32_t flags, const F (&coordinate)[N], const VoronoiOctaves<F> &of,
                                       const VoronoiShape<F> &shape) {
  const F zero(0.0f), one(1.0f);
  const bool is_second = feature == VoronoiFeatureKind::F2, is_smooth = feature == VoronoiFeatureKind::SmoothF1;
  F distance = zero, position[N], scale = one, amplitude = one, most = zero;
  Vector3<F> color(zero);
  for (int i = 0; i < N; ++i)
    position[i] = zero;
  for (int octave = 0; octave < 17; ++octave) {
    const F share = share_of_octave(octave, of.detail);
    const MaskOf<F> counts = share > zero;
    if (!any(counts))
      break;
    F p[N];
    for (int i = 0; i < N; ++i)
      p[i] = coordinate[i] * scale;
    VoronoiFeature<N, F> found = is_smooth ? smooth_feature(p, shape) : nearest_feature(p, shape, is_second);
    const MaskOf<F> sharp = shape.smoothness == zero;
    if (is_smooth && any(sharp)) {
      const VoronoiFeature<N, F> nearest = nearest_feature(p, shape, false);
      found.distance = select(sharp, nearest.distance, found.distance);
      found.color = select(sharp, nearest.color, found.color);
      assign_where(sharp, nearest.position, found.position);
    }
    const F weight = share * amplitude;
    most = select(counts, most + weight, most);
    distance = select(counts, distance + found.distance * weight, distance);
    color = select(counts, color + found.color * weight, color);
    for (int i = 0; i < N; ++i) {
      const F mixed = (one - amplitude) * position[i] + amplitude * (found.position[i] / scale);
      position[i] = select(counts, (one - share) * position[i] + share * mixed, position[i]);
    }
    scale = scale * of.lacunarity;
    amplitude = amplitude * of.roughness;
  }
  if (flags & VoronoiFlag::Normalized) {
    F corner[N];
    for (int i = 0; i < N; ++i)
      corner[i] = F(0.5f) + F(0.5f) * shape.randomness;
    const F furthest = distance_of<N>(measure_of(corner, shape), shape) * F(is_second ? 2.0f : 1.0f);
    distance = distance / (most * furthest);
    color = color / most;
  }
  if (!(flags & VoronoiFlag::Position))
    return {flags & VoronoiFlag::Color ? color : Vector3<F>(distance), distance};
  // One dimension is w, the fourth coordinate.
  F axes[4] = {zero, zero, zero, zero};
  for (int i = 0; i < N; ++i)
    axes[N == 1 ? 3 : i] = select(of.scale == zero, zero, position[i] / of.scale);
  return {{axes[0], axes[1], axes[2]}, axes[3]};
}

template <int N, class F>
static F voronoi_edges(uint32_t flags, const F (&coordinate)[N], const VoronoiOctaves<F> &of, const VoronoiShape<F> &shape) {
  const F zero(0.0f), one(1.0f), furthest = F(0.5f) + F(0.5f) * shape.randomness;
  F distance(8.0f), scale = one, amplitude = one, most = furthest;
  for (int octave = 0; octave < 17; ++octave) {
    const F share = share_of_octave(octave, of.detail);
    const MaskOf<F> counts = share > zero;
    if (!any(counts))
      break;
    F p[N];
    for (int i = 0; i < N; ++i)
      p[i] = coordinate[i] * scale;
    const F nearest = min(distance, edge_distance(p, shape) / scale);
    const F mixed = (one - amplitude) * distance + amplitude * nearest;
    const F limit = (one - amplitude) * most + amplitude * (furthest / scale);
    distance = select(counts, (one - share) * distance + share * min(distance, mixed), distance);
    most = select(counts, (one - share) * most + share * limit, most);
    scale = scale * of.lacunarity;
    amplitude = amplitude * of.roughness;
  }
  return flags & VoronoiFlag::Normalized ? distance / most : distance;
}

template <int N, class F>
LANCER_LANE VoronoiValue<F> voronoi_at(uint32_t feature, uint32_t flags, const F (&coordinate)[N], const VoronoiOctaves<F> &of,
                                       const VoronoiShape<F> &shape) {
  if (feature == VoronoiFeatureKind::DistanceToEdge || feature == VoronoiFeatureKind::NSphereRadius) {
    const F number = feature == VoronoiFeatureKind::NSphereRadius ? sphere_radius(coordinate, shape)
                                                                  : voronoi_edges(flags, coordinate, of, shape);
    return {Vector3<F>(number), number};
  }
  return voronoi_octaves(feature, flags, coordinate, of, shape);
}

// The node VORONOI: place is w, scale and randomness; octaves detail, roughness and lacunarity; form smoothness and exponent.
template <class F>
LANCER_LANE VoronoiValue<F> voronoi_texture(uint32_t feature, uint32_t flags, const Vector3<F> &vector, const Vector3<F> &place,
                                            const Vector3<F> &octaves, const Vector3<F> &form) {
  const F zero(0.0f), one(1.0f);
  VoronoiShape<F> shape;
  shape.metric = flags >> 2 & 3;
  shape.by_integers = (flags & VoronoiFlag::Integers) != 0;
  shape.is_bounded = (flags & VoronoiFlag::Bounded) != 0;
  shape.smoothness = min(F(0.5f), max(zero, form.x / F(2.0f)));
  shape.exponent = form.y;
  shape.randomness = min(one, max(zero, place.z));
  const F roughness = min(one, max(zero, octaves.y));
  // With zero roughness there is one octave.
  const F detail = select(roughness == zero, zero, min(F(15.0f), max(zero, octaves.x)));
  const VoronoiOctaves<F> of{place.y, detail, roughness, octaves.z};
  const F x = vector.x * of.scale, y = vector.y * of.scale, z = vector.z * of.scale, w = place.x * of.scale;
  switch (flags & 3) {
  case 0:
    return voronoi_at<1, F>(feature, flags, {w}, of, shape);
  case 1:
    return voronoi_at<2, F>(feature, flags, {x, y}, of, shape);
  case 2:
    return voronoi_at<3, F>(feature, flags, {x, y, z}, of, shape);
  default:
    return voronoi_at<4, F>(feature, flags, {x, y, z, w}, of, shape);
  }
}

} // namespace lancer
