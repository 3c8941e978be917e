// A camera of 200 x 100 pixels at the origin, with a window of the whole picture.
#pragma once

#include "scene/camera.h"

namespace lancer_test {

inline lancer::Camera camera(lancer::CameraKind kind, const std::array<double, 8> &panorama) {
  lancer::Camera result;
  result.kind = kind;
  result.panorama = panorama;
  result.width = 200;
  result.height = 100;
  result.left = result.bottom = 0.0;
  result.right = result.top = 1.0;
  result.clip_start = 0.1;
  result.clip_end = 50.0;
  return result;
}

} // namespace lancer_test
