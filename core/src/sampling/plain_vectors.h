// Copies of vectors in the plain arrays of records that kernels read.
#pragma once

#include <glm/glm.hpp>

namespace lancer {

template <class T> void copy(const glm::vec<3, T> &from, T (&to)[3]) {
  for (int i = 0; i < 3; ++i)
    to[i] = from[i];
}

} // namespace lancer
