// Matrices of nodes that are the same for all places.
#pragma once

#include <glm/glm.hpp>

namespace lancer {

// By Euler angles, x first.
glm::mat3 rotation(const glm::vec3 &angles);
// 3 x 3, both row-major; false where there is none.
bool inverse_transpose(const float (&rows)[9], double (&result)[9]);

} // namespace lancer
