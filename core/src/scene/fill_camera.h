// Checks and copies a camera; an Error says what no camera can have.
#pragma once

#include "lancer.h"
#include "scene/camera.h"

namespace lancer {

Camera read_camera(const lancer_camera &source);
// An Error where the camera, in the normalised world, is too far from everything.
void check_reach(const Camera &camera);

} // namespace lancer
