// Scalars of a colour, for choices, weights and alpha.
#pragma once

#include "simd/vectors.h"

#include <algorithm>

namespace lancer {

template <class V> LANCER_LANE NumberOf<V> mean(const V &v) { return (v.x + v.y + v.z) / 3.0f; }

// Luminance of linear light with the primaries of ITU-R BT.709.
template <class T> T luminance(const glm::vec<3, T> &v) { return T(0.2126f) * v.x + T(0.7152f) * v.y + T(0.0722f) * v.z; }

template <class V> LANCER_LANE NumberOf<V> largest(const V &v) { return max(max(v.x, v.y), v.z); }

} // namespace lancer
