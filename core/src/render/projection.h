// Projection from the world to pixels of a flat picture, with a margin for the filter and the lens.
#pragma once

#include "scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lancer {

// A point in camera space: x and y across, z the depth along the axis.
using CameraPoint = glm::dvec3;

class Projection {
public:
  // camera: no panorama. filter_width: in pixels.
  Projection(const Camera &camera, double filter_width)
      : perspective_(camera.kind == CameraKind::Perspective), nearest_(std::max(0.999 * camera.clip_start, 1e-30)),
        scale_(camera.width / (camera.right - camera.left), camera.height / (camera.top - camera.bottom)),
        shift_(-camera.left * scale_.x - camera.x, -camera.bottom * scale_.y - camera.y), filter_(0.5 * filter_width + kSlack),
        lens_(camera.lens_radius * std::max(1.0, 1.0 / camera.aperture_ratio) *
              std::max(std::abs(scale_.x), std::abs(scale_.y))),
        in_focus_(camera.focal_distance) {
    glm::dmat3 axes = camera.to_world.linear;
    axes[2] = -axes[2];
    to_camera_.linear = glm::transpose(axes);
    to_camera_.translation = -(to_camera_.linear * camera.to_world.translation);
  }

  const Affine &to_camera() const { return to_camera_; }
  // Whether a point lies beyond the near plane; always true for an orthographic camera.
  bool is_beyond(const CameraPoint &point) const { return !perspective_ || point.z > nearest_; }
  // Returns the pixel in the region, from its lower left corner.
  glm::dvec2 pixel(const CameraPoint &point) const {
    return scale_ * (perspective_ ? glm::dvec2(point) / point.z : glm::dvec2(point)) + shift_;
  }
  // Returns the distance in pixels around pixel(point) within which the point may be visible. Over a polygon, the lens's share
  // of this distance is largest at a corner: in the polygon's plane the inverse depth (orthographic: the depth) is a linear
  // function of the pixel.
  double margin(const CameraPoint &point) const {
    if (!(lens_ > 0.0))
      return filter_;
    return filter_ + lens_ * std::abs(perspective_ ? 1.0 / point.z - 1.0 / in_focus_ : 1.0 - point.z / in_focus_);
  }
  // Clips a triangle at the near plane. Returns the number of corners of the rest, at most four.
  uint32_t clip(const std::array<CameraPoint, 3> &triangle, std::array<CameraPoint, 4> &left) const {
    uint32_t count = 0;
    for (int i = 0; i < 3; ++i) {
      const CameraPoint &from = triangle[i], &to = triangle[(i + 1) % 3];
      if (is_beyond(from))
        left[count++] = from;
      if (is_beyond(from) == is_beyond(to))
        continue;
      left[count] = glm::mix(from, to, (nearest_ - from.z) / (to.z - from.z));
      left[count++].z = nearest_;
    }
    return count;
  }

private:
  // In pixels: far above the rounding error of a ray or a corner.
  static constexpr double kSlack = 1.0 / 16.0;

  bool perspective_;
  double nearest_;
  Affine to_camera_;
  glm::dvec2 scale_, shift_; // from the window to pixels
  double filter_;            // radius of the pixel filter, in pixels
  double lens_, in_focus_;   // radius of the lens, in pixels at depth 1; depth of the plane in focus
};

} // namespace lancer
