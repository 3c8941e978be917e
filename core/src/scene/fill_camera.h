// Checks and copies a camera; an Error says what no camera can have.
#pragma once

#include "lancer.h"
#include "scene/camera.h"

namespace lancer {

Camera read_camera(const lancer_camera &source);

} // namespace lancer
