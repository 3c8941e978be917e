// The environment as kernels read it: plain numbers.
#pragma once

#include "sampling/direction_map.h"
#include "scene/wide_image.h"

namespace lancer {

struct Image;
struct World;

struct WideSky {
  DirectionTable map;
  WideImage image;                                        // over all directions; no texels: only nodes know the radiance
  uint32_t mapped = 0;                                    // the picture's direction is turn (scale d) + location
  float turn[3][3] = {}, scale[3] = {}, location[3] = {}; // turn: columns
  uint32_t multiplied = 0;
  float factor[3] = {}; // of the picture's colour
};

// As long as none of what it was made of is changed or moved.
WideSky make_wide_sky(const World &world, const std::vector<Image> &images, const DirectionMap &map);

} // namespace lancer
