#include "scene/fill.h"

#include "scene/geometry.h"
#include "scene/messages.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace lancer {

namespace {

void check_rigid(const Affine &map) {
  if (!map.finite())
    bad_argument("camera: its matrix is not finite");
  // Blender's matrices are products of floats, so their columns are unit within about 1e-6. A scale exceeds this by far.
  const glm::dmat3 gram = glm::transpose(map.linear) * map.linear;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(gram[i][k] - (i == k ? 1.0 : 0.0)) < 1e-3))
        bad_argument("camera: its matrix must be a rotation and a translation, without scale");
}

void check_region(const lancer_camera &source) {
  const auto text = [](uint32_t value) { return std::to_string(value); };
  if (source.width == 0 || source.height == 0)
    bad_argument("camera: resolution " + text(source.width) + " x " + text(source.height) + " has no pixels");
  if (source.region_width == 0 || source.region_height == 0)
    bad_argument("camera: region " + text(source.region_width) + " x " + text(source.region_height) + " has no pixels");
  if (uint64_t(source.x) + source.region_width > source.width || uint64_t(source.y) + source.region_height > source.height)
    bad_argument("camera: region " + text(source.region_width) + " x " + text(source.region_height) + " at (" + text(source.x) +
                 ", " + text(source.y) + ") leaves the image of " + text(source.width) + " x " + text(source.height));
}

// Checks the divisors and angles of a projection.
void check_panorama(const lancer_camera &source) {
  const double *p = source.panorama;
  for (int i = 0; i < 8; ++i)
    if (!std::isfinite(p[i]))
      bad_argument("camera: panorama[" + std::to_string(i) + "] is not finite");
  const auto positive = [&](int i, const char *what) {
    if (!(p[i] > 0.0))
      bad_argument("camera: " + std::string(what) + " " + std::to_string(p[i]) + " must be positive");
  };
  switch (source.kind) {
  case LANCER_FISHEYE_EQUIDISTANT:
    positive(0, "field of view");
    break;
  case LANCER_FISHEYE_EQUISOLID:
    positive(0, "focal length");
    positive(1, "field of view");
    positive(2, "sensor width");
    positive(3, "sensor height");
    break;
  case LANCER_FISHEYE_POLYNOMIAL:
    positive(0, "field of view");
    positive(1, "sensor width");
    positive(2, "sensor height");
    break;
  case LANCER_CYLINDRICAL:
    positive(4, "radius");
    break;
  default:
    break;
  }
}

} // namespace

void check_reach(const Camera &camera) {
  // Squares of distances must fit into floats. Up to 2^60 this holds even for sums of several squares. The scene is 2^10 wide.
  const double place = largest_coordinate(camera.to_world.translation);
  if (!(place < 0x1p60 && camera.lens_radius < 0x1p60))
    bad_argument("camera: its distance or its lens radius is more than 1e15 times the scene's size");
}

Camera read_camera(const lancer_camera &source) {
  if (source.kind > LANCER_CYLINDRICAL)
    bad_argument("camera: kind " + std::to_string(source.kind) + " is not one of 0 ... " + std::to_string(LANCER_CYLINDRICAL));
  check_region(source);
  Camera camera;
  camera.to_world = Affine::from_rows(source.matrix);
  check_rigid(camera.to_world);
  for (double edge : source.window)
    if (!std::isfinite(edge))
      bad_argument("camera: its window is not finite");
  if (source.window[0] == source.window[1] || source.window[2] == source.window[3])
    bad_argument("camera: its window is empty");
  if (!(source.clip_start >= 0.0) || !(source.clip_end > source.clip_start))
    bad_argument("camera: clip range " + std::to_string(source.clip_start) + " ... " + std::to_string(source.clip_end) +
                 " is empty");
  check_panorama(source);
  if (!std::isfinite(source.aperture_rotation))
    bad_argument("camera: aperture rotation " + std::to_string(source.aperture_rotation) + " is not finite");
  if (source.lens_radius > 0.0 && (!(source.aperture_ratio > 0.0) || !std::isfinite(source.aperture_ratio)))
    bad_argument("camera: aperture ratio " + std::to_string(source.aperture_ratio) + " must be positive and finite");
  if (!(source.lens_radius >= 0.0) || !std::isfinite(source.lens_radius))
    bad_argument("camera: lens radius " + std::to_string(source.lens_radius) + " must be finite and not negative");
  if (source.lens_radius > 0.0 && !(source.focal_distance > 0.0))
    bad_argument("camera: focal distance " + std::to_string(source.focal_distance) + " must be positive");
  for (const double number : {source.eye_offset, source.convergence_distance, source.pole_merge_from, source.pole_merge_to})
    if (!std::isfinite(number))
      bad_argument("camera: a number of its spherical stereo is not finite");
  if (source.eye_offset != 0.0 && source.kind == LANCER_ORTHOGRAPHIC)
    bad_argument("camera: an orthographic camera has no spherical stereo");
  camera.kind = static_cast<CameraKind>(source.kind);
  std::copy(source.panorama, source.panorama + 8, camera.panorama.begin());
  camera.width = source.width;
  camera.height = source.height;
  camera.x = source.x;
  camera.y = source.y;
  camera.region_width = source.region_width;
  camera.region_height = source.region_height;
  camera.left = source.window[0];
  camera.right = source.window[1];
  camera.bottom = source.window[2];
  camera.top = source.window[3];
  camera.clip_start = source.clip_start;
  camera.clip_end = source.clip_end;
  camera.lens_radius = source.lens_radius;
  camera.focal_distance = source.focal_distance;
  camera.aperture_blades = source.aperture_blades;
  camera.aperture_rotation = source.aperture_rotation;
  camera.eye_offset = source.eye_offset;
  camera.convergence = std::max(source.convergence_distance, 0.0);
  camera.pole_merge_from = source.pole_merge_from;
  camera.pole_merge_to = source.pole_merge_to;
  camera.aperture_ratio = source.lens_radius > 0.0 ? source.aperture_ratio : 1.0;
  return camera;
}

} // namespace lancer
