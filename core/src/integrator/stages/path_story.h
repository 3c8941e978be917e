// What a Light Path node is told of a path: by what its last ray was sent, and how often it was scattered in which way.
#pragma once

#include "nodes/light_path.h"

#include <algorithm>

namespace lancer {

struct PathStory {
  uint8_t kinds = LANCER_RAY_CAMERA; // as LightPath::kinds
  uint8_t diffuse = 0, glossy = 0, transmission = 0;

  // Beyond 255 scatterings the counts stay.
  void scatter(bool is_diffuse, bool transmitted, bool singular) {
    uint8_t &count = transmitted ? transmission : is_diffuse ? diffuse : glossy;
    count = uint8_t(std::min(count + 1, 255));
    kinds = uint8_t((is_diffuse ? LANCER_RAY_DIFFUSE : LANCER_RAY_GLOSSY) |
                    (transmitted ? uint32_t(LANCER_RAY_TRANSMISSION) : kRayReflected) | (singular ? kRaySingular : 0));
  }
  LightPath<float> told(float length, uint32_t scatterings, uint32_t passed_through) const {
    return {.kinds = kinds,
            .length = length,
            .depth = float(scatterings),
            .diffuse = float(diffuse),
            .glossy = float(glossy),
            .transmission = float(transmission),
            .transparent = float(passed_through)};
  }
};

} // namespace lancer
