#include "nodes/rotation.h"

#include "nodes/vector_nodes.h"

namespace lancer {

glm::mat3 rotation(const glm::vec3 &angles) {
  const Columns<float> turn = turn_by(Vector3<float>(angles));
  return {turn.c[0], turn.c[1], turn.c[2]};
}

bool inverse_transpose(const float (&rows)[9], double (&result)[9]) {
  glm::dmat3 m;
  for (int i = 0; i < 9; ++i)
    m[i % 3][i / 3] = double(rows[i]);
  if (glm::determinant(m) == 0.0)
    return false;
  const glm::dmat3 back = glm::transpose(glm::inverse(m));
  for (int i = 0; i < 9; ++i)
    result[i] = back[i % 3][i / 3];
  return true;
}

} // namespace lancer
