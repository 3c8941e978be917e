// Sine and cosine of numbers of a sample: the same bits from every library, compiler and number of lanes.
#pragma once

#include <cstdint>

namespace lancer {

// |x| <= pi/4. Float is a float, or lanes of them. Fitted to a relative error of 4e-9: what is left is rounding, about one
// unit in the last place.
template <class Float> [[gnu::always_inline]] inline Float sin_octant(Float x) {
  const Float z = x * x;
  return x + x * z * (Float(-0.16666655f) + z * (Float(0.00833218f) + z * Float(-0.00019517f)));
}
template <class Float> [[gnu::always_inline]] inline Float cos_octant(Float x) {
  const Float z = x * x;
  return Float(1.0f) - Float(0.5f) * z +
         z * z * (Float(0.0416666456f) + z * (Float(-0.00138873675f) + z * Float(2.44384509e-5f)));
}

// Of u turns, u in [0, 1].
struct SinCos {
  float sin, cos;
};
inline SinCos sin_cos_turn(float u) {
  // Subtract the nearest quarter, which is exact, and turn back by it.
  const int32_t quarter = static_cast<int32_t>(4.0f * u + 0.5f);
  const float x = 6.28318531f * (u - 0.25f * static_cast<float>(quarter));
  const float s = sin_octant(x), c = cos_octant(x);
  const float sine = quarter & 1 ? c : s, cosine = quarter & 1 ? s : c;
  return {quarter & 2 ? -sine : sine, (quarter + 1) & 2 ? -cosine : cosine};
}

} // namespace lancer
