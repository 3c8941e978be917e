// The pixels that may show a surface or lamp, found before the first sample. All other pixels show the background and are not
// traced.
#pragma once

#include "compile/scene.h"
#include "integrator/sample.h"
#include "render/film.h"
#include "render/projection.h"

#include <span>
#include <vector>

namespace lancer {

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
  bool add_surfaces(const Geometry &geometry, const Projection &projection, uint64_t effort);
  void add_triangles(const Projection &projection, const Affine &to_camera, const Mesh &mesh);
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
};

// camera: normalised. Returns a coverage of all pixels if the background varies, if few samples are planned, or if all features
// are requested.
Background find_background(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Film &film);

// Whether all camera rays that miss the scene return the same radiance.
bool has_even_background(const Scene &scene, const Camera &camera);

} // namespace lancer
