// A lamp as kernels read it: the plain numbers of Light.
#pragma once

#include <cstdint>

namespace lancer {

struct WideLamp {
  uint32_t kind = 0; // LightKind
  uint32_t soft = 0, spot_cosine = 0, ellipse = 0;
  double position[3] = {}, x[3] = {}, y[3] = {}, z[3] = {}, emission[3] = {};
  double radius = 0.0, cos_half_angle = 0.0, blend_width = 0.0, stretch_x = 1.0, stretch_y = 1.0;
  double half_x = 0.0, half_y = 0.0, area = 0.0, tan_half_spread = 0.0, spread_scale = 0.0, apart = 0.0;
  double one_minus_cos_sun = 0.0, flat_radius = 0.0;
};

} // namespace lancer
