// Four floats in a register, by the compiler's own vectors: SSE, NEON and their kin.
#pragma once

#include <cmath>

namespace lancer {

using Float4 [[gnu::vector_size(16), gnu::may_alias]] = float;

inline Float4 load4(const float *p) { return *reinterpret_cast<const Float4 *>(p); } // p: a multiple of 16
inline Float4 all4(float x) { return Float4{x, x, x, x}; }
inline Float4 larger4(Float4 a, Float4 b) { return a > b ? a : b; }
inline Float4 sqrt4(Float4 x) {
  Float4 result;
  for (int i = 0; i < 4; ++i)
    result[i] = std::sqrt(x[i]);
  return result;
}
// From the cosine.
inline Float4 sine4(Float4 cosine) { return sqrt4(larger4((1.0f - cosine) * (1.0f + cosine), all4(0.0f))); }

} // namespace lancer
