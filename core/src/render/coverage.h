// The pixels that may show a surface or lamp, found before the first sample by projection, with a margin for the filter and the
// lens. All other pixels show the background and are not traced.
#pragma once

#include "compile/scene.h"
#include "integrator/sample.h"
#include "render/film.h"
#include "scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace lancer {

// A point in camera space: x and y across, z the depth along the axis.
using CameraPoint = glm::dvec3;

// Projection from the world to pixels of a flat picture, with a margin for the filter and the lens.
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

// Blocks of pixels of the region in which some surface or lamp may be visible. Triangles are projected with a margin for the
// filter and the lens: an unmarked block is certainly empty.
class Coverage {
public:
  // Treats all pixels as covered.
  Coverage() = default;
  // camera: normalised, no panorama. filter_width: in pixels. effort: the most triangles that may be projected; if the scene
  // has more, or surfaces without bounds, all pixels are treated as covered.
  Coverage(const Scene &scene, const Camera &camera, double filter_width, uint64_t effort);

  // Whether a sample of this pixel of the region may hit anything.
  bool covers(uint32_t x, uint32_t y) const {
    return blocks_.empty() || blocks_[size_t(y / kBlock) * across_ + x / kBlock] != 0;
  }
  bool covers_all() const { return blocks_.empty(); }
  // Returns a pixel that is not covered; there must be one.
  glm::uvec2 empty_pixel() const {
    const auto block = uint32_t(std::ranges::find(blocks_, 0) - blocks_.begin());
    return {block % across_ * kBlock, block / across_ * kBlock};
  }

private:
  static constexpr uint32_t kBlock = 8;
  // A rectangle of blocks; end is exclusive.
  struct Blocks {
    glm::uvec2 begin{0}, end{0};
    uint32_t count() const { return (end.x - begin.x) * (end.y - begin.y); }
  };

  void add_lamps(const LightSet &lights, const Projection &projection);
  bool add_surfaces(const GeometryView &geometry, const Projection &projection, uint64_t effort);
  void add_triangles(const Projection &projection, const Affine &to_camera, const MeshView &mesh);
  void add_polygon(std::span<const glm::dvec2> corners, double margin);
  // Returns the blocks in which a box may be visible.
  Blocks around(const Projection &projection, const Affine &to_camera, const glm::dvec3 &low, const glm::dvec3 &high) const;
  Blocks within(const glm::dvec2 &low, const glm::dvec2 &high) const;
  bool marked(const Blocks &blocks) const;
  void mark(const Blocks &blocks);

  std::vector<uint8_t> blocks_; // 1: may be covered; empty: all may be
  uint32_t across_ = 0, up_ = 0;
  std::vector<CameraPoint> points_; // of the current mesh
  std::vector<glm::dvec2> pixels_;  // of the points beyond the near plane
};

// The uniform background of a picture: pixels that show nothing else share one sample.

struct Background {
  Coverage coverage;
  SampleResult sample = SampleResult(); // of every pixel that is not covered
  Extras extras{};                      // of the sample
};

// camera: normalised. Returns a coverage of all pixels if the background varies, if few samples are planned, or if all features
// are requested.
Background find_background(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Film &film);

// Whether all camera rays that miss the scene return the same radiance.
bool has_even_background(const Scene &scene, const Camera &camera);

} // namespace lancer
