// Where a way to an area lamp ends: just before it, so that rounding puts no face of the lamp's own plane, such as the ceiling
// that it is set into, before the lamp.
#pragma once

#include <algorithm>

namespace lancer {

// At grazing directions a way ends at most this many times Light::apart before the lamp: nothing visible stands in between.
inline constexpr double kMostAparts = 64.0;

// How long the way is that ends before the lamp, of one that is t long and meets its axis under this cosine. Double is a
// double, or lanes of them.
template <class Double> [[gnu::always_inline]] inline Double area_end(Double t, Double cosine, Double apart) {
  using std::max;
  using std::min;
  return max(t - min(apart / cosine, Double(kMostAparts) * apart), Double(0.5) * t);
}

} // namespace lancer
