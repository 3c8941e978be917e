// Numbers from outside that stand for random ones.
#pragma once

#include "scene/error.h"

#include <cstddef>
#include <string>

namespace lancer {

inline void check_unit(const float *u, size_t count) {
  for (size_t i = 0; i < count; ++i)
    if (!(u[i] >= 0.0f && u[i] < 1.0f))
      bad_argument("probe: u " + std::to_string(u[i]) + " is not in [0, 1)");
}

} // namespace lancer
