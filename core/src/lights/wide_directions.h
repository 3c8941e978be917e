// The picture of the environment for many lanes at once, with the bits of image_nodes.h. For kernels only, like simd/lanes.h.
#pragma once

#include "lights/wide_sky.h"
#include "nodes/look_up.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// As the picture's nodes see unit direction d; place: of d itself.
LANCER_LANE V3 picture_at(const WideSky &sky, const V3 &d, const MapPlace<D> &place) {
  MapPlace<D> seen = place;
  M somewhere = mask_of((1u << kLanes) - 1u);
  if (sky.mapped) {
    // mapping()
    const auto &t = sky.turn;
    const V3 s{d.x * F(sky.scale[0]), d.y * F(sky.scale[1]), d.z * F(sky.scale[2])};
    const V3 v{F(t[0][0]) * s.x + F(t[1][0]) * s.y + F(t[2][0]) * s.z + F(sky.location[0]),
               F(t[0][1]) * s.x + F(t[1][1]) * s.y + F(t[2][1]) * s.z + F(sky.location[1]),
               F(t[0][2]) * s.x + F(t[1][2]) * s.y + F(t[2][2]) * s.z + F(sky.location[2])};
    seen = place_of(v);
    somewhere = !black(v);
  }
  const F zero(0.0f);
  V3 color =
      look_up(sky.image, select(somewhere, narrow(D(0.5) - seen.x), zero), select(somewhere, narrow(D(0.5) + seen.y), zero))
          .color;
  if (sky.multiplied)
    color = color * V3{F(sky.factor[0]), F(sky.factor[1]), F(sky.factor[2])};
  return color;
}

} // namespace
} // namespace lancer
