// The specialisations of the path integrator that pay, for the files that its functions stand in.
#pragma once

#include "integrator/path.h"

namespace lancer {

inline constexpr uint32_t kMatteShapes = shape_bit(LobeShape::Lambert);
inline constexpr uint32_t kPlasticShapes = kMatteShapes | shape_bit(LobeShape::Beckmann) | shape_bit(LobeShape::Microfacet);

#define LANCER_PATH_KINDS(each)                                                                                                \
  each(kAllShapes, true) each(kAllShapes, false) each(kPlasticShapes, false) each(kMatteShapes, false)

} // namespace lancer
