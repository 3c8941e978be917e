// Checks and copies the places of instances and of the camera at the moments of the pass Vector.
#include "scene/fill.h"

#include <algorithm>
#include <vector>

namespace lancer {

void set_vectors(Description &description, uint32_t count, const uint32_t *instances, const double *matrices) {
  if (count > 0 && (!instances || !matrices))
    bad_argument("vectors: NULL for " + std::to_string(count) + " instances");
  std::vector<bool> given(description.instances_given);
  for (uint32_t i = 0; i < count; ++i) {
    if (instances[i] >= description.instances_given)
      bad_argument("vectors: instance " + std::to_string(instances[i]) + " >= " + std::to_string(description.instances_given) +
                   " instances");
    if (given[instances[i]])
      bad_argument("vectors: instance " + std::to_string(instances[i]) + " was given before");
    given[instances[i]] = true;
  }
  description.vectors.clear();
  for (uint32_t i = 0; i < count; ++i) {
    GivenVectors vectors{instances[i], {}};
    for (uint32_t moment = 0; moment < kMoments; ++moment)
      vectors.to_world[moment] = Affine::from_rows(matrices + (size_t(i) * kMoments + moment) * 12);
    if (vectors.to_world[0].finite() && vectors.to_world[1].finite())
      description.vectors.push_back(vectors);
    else
      description.instance_messages.add("instance #" + std::to_string(instances[i]),
                                        "a matrix one frame before or after is not finite; in the pass Vector it stands still");
  }
}

CameraMoments read_camera_moments(const lancer_camera &source) {
  CameraMoments moments;
  const double *const matrices[] = {source.matrix_before, source.matrix_after};
  const double *const windows[] = {source.window_before, source.window_after};
  for (uint32_t moment = 0; moment < kMoments; ++moment) {
    lancer_camera at_moment = source;
    if (std::any_of(matrices[moment], matrices[moment] + 12, [](double number) { return number != 0.0; })) {
      std::copy_n(matrices[moment], 12, at_moment.matrix);
      std::copy_n(windows[moment], 4, at_moment.window);
      moments.moves = true;
    }
    moments.cameras[moment] = read_camera(at_moment);
  }
  return moments;
}

} // namespace lancer
