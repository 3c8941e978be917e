// Lookups in cubes of voxels, interpolated along all three axes. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/image_nodes.h"

namespace lancer {
namespace {

// Returns the view of an image whose rows are those of a cube, layer by layer.
LANCER_LANE ImageLevel voxel_level(const ImageView &image, uint32_t interpolation) {
  ImageLevel r = image_level(image, uint32_t(Extension::Clip) | interpolation << 4);
  r.keeps_alpha = true;
  return r;
}

// Returns the voxels at a point, (0, 0, 0) and (1, 1, 1) opposite corners of the cube; 0 outside, and if a coordinate is not
// finite. Voxels beyond the border count as 0.
template <class F> Texel<F> look_up_voxels(const ImageLevel &image, const Vector3<F> &p) {
  const F zero(0.0f), side(static_cast<float>(image.width));
  const auto place = is_finite(p.x) & is_finite(p.y) & is_finite(p.z);
  const auto along = [&](const F &c) __attribute__((always_inline)) {
    return taps(select(place, c, zero), image.width, image.extension, image.interpolation);
  };
  const Taps<F> x = along(p.x), y = along(p.y), z = along(p.z);
  Texel<F> sum = Texel<F>::zero();
  for (int k = 0; k < z.count; ++k)
    for (int j = 0; j < y.count; ++j) {
      const auto line = place & z.there[k] & y.there[j];
      if (!any(line))
        continue;
      const F row = z.at[k] * side + y.at[j];
      for (int i = 0; i < x.count; ++i) {
        Texel<F> voxel;
        read<4>(image, x.at[i], row, voxel);
        if (x.count > 1)
          voxel = z.weight[k] * (y.weight[j] * (x.weight[i] * voxel));
        sum = sum + select(line & x.there[i], voxel, Texel<F>::zero());
      }
    }
  if (image.has_gaps) {
    const Vector3<F> &c = sum.color;
    sum = select(is_finite(c.x) & is_finite(c.y) & is_finite(c.z) & is_finite(sum.alpha), sum, Texel<F>::zero());
  }
  return sum;
}

// The node VOXELS.
template <class F> Value<F> voxels_node(const Inputs<F> &in) {
  const Texel<F> found = look_up_voxels(voxel_level(picture(in, 0), in.node.option), in[0]);
  return {found.color, found.alpha};
}

} // namespace
} // namespace lancer
