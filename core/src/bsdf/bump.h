// Where a lobe's normal and the shading normal disagree: what bump and normal maps must not light, and how the lit side ends.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/lobe.h"
#include "bsdf/matte.h"

namespace lancer {

// Whether the lit side of a bump ends smoothly: lobes that scatter widely.
inline bool ends_smoothly(const Lobe &lobe) {
  return lobe.shape == LobeShape::Lambert || lobe.shape == LobeShape::Matte || lobe.shape == LobeShape::Sheen;
}

// Whether bump takes light from a direction, as Cycles asks it: of what a lobe draws itself only where it reflects widely, of
// all other light of every lobe but velvet.
inline bool bump_acts(const Lobe &lobe, bool drawn) {
  if (lobe.shape == LobeShape::Matte && matte_transmits(lobe))
    return !drawn;
  if (lobe.shape == LobeShape::Matte && lobe.variant == static_cast<uint8_t>(Matte::Velvet))
    return drawn;
  return !drawn || ends_smoothly(lobe);
}

// Chiang, Li, Burley, "Taming the shadow terminator", 2019: a cubic in the ratio of cosines.
inline float chiang_shadowing(float cos_ns, float cos_n, float cos_tilt, bool softened) {
  const float ratio = cos_ns / (cos_n * cos_tilt);
  if (!(ratio > 0.0f))
    return 0.0f;
  if (!softened || ratio >= 1.0f)
    return 1.0f;
  return ratio * (1.0f + ratio * (1.0f - ratio));
}

// Conty Estevez, Lecocq, Stein, "A microfacet-based shadowing function to solve the bump terminator problem", 2019: the bump
// stands for facets of GGX whose roughness follows from its tilt.
inline float conty_shadowing(float cos_ns, float cos_tilt) {
  const float c = std::abs(cos_ns), tilt = std::abs(cos_tilt);
  if (c >= 1.0f || tilt >= 1.0f)
    return 1.0f;
  const auto tan2 = [](float x) { return (1.0f - x) * (1.0f + x) / (x * x); };
  const float alpha2 = std::min(0.125f * tan2(tilt), 1.0f);
  return 2.0f / (1.0f + std::sqrt(1.0f + alpha2 * tan2(c)));
}

// What a lobe about n keeps of light from a direction with cosines cos_ns to the shading normal ns and cos_n to n.
inline float bump_factor(const Lobe &lobe, const glm::vec3 &n, const glm::vec3 &ns, float cos_ns, float cos_n,
                         bool correction) {
  if (n == ns)
    return 1.0f;
  const float cos_tilt = glm::dot(n, ns);
  const bool smooth_end = ends_smoothly(lobe);
  if (lobe.rules != Rules::Blender45 && smooth_end)
    return chiang_shadowing(cos_ns, cos_n, cos_tilt, correction);
  // On the other side of the surface than the lobe believes; Blender 3.x asked this of wide lobes only.
  if (lobe.rules != Rules::Blender3 && cos_ns * cos_tilt * cos_n < 0.0f)
    return 0.0f;
  return smooth_end && correction ? conty_shadowing(cos_ns, cos_tilt) : 1.0f;
}

} // namespace lancer
