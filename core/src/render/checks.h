// What the probes are given from outside: numbers that stand for random ones, and directions.
#pragma once

#include "scene/error.h"

#include <cmath>
#include <cstddef>
#include <string>

namespace lancer {

inline void check_unit(const float *u, size_t count) {
  for (size_t i = 0; i < count; ++i)
    if (!(u[i] >= 0.0f && u[i] < 1.0f))
      bad_argument("probe: u " + std::to_string(u[i]) + " is not in [0, 1)");
}

inline void check_directions(const double *directions, size_t count) {
  for (size_t i = 0; i < 3 * count; ++i)
    if (!std::isfinite(directions[i]))
      bad_argument("probe: direction " + std::to_string(i / 3) + " holds " + std::to_string(directions[i]));
}

} // namespace lancer
