// Generates a ray from a place on the film: flat projections, panoramas, the lens.
#pragma once

#include "scene/affine.h"
#include "scene/ray.h"

#include <array>

namespace lancer {

enum class CameraKind : uint32_t {
  Perspective = 0,
  Orthographic = 1,
  Equirectangular = 2,
  FisheyeEquidistant = 3,
  FisheyeEquisolid = 4,
  FisheyePolynomial = 5,
  MirrorBall = 6,
  Cylindrical = 7
};

// The camera looks along its local -z, y up. The window is the full image's rectangle: on the plane z = -1 (perspective), at
// any depth (orthographic), or as a part of the whole panorama, which is 0 ... 1. The window includes sensor fit, shift and
// pixel aspect.
struct Camera {
  Affine to_world;
  CameraKind kind = CameraKind::Perspective;
  uint32_t width = 0, height = 0; // full image, pixels
  uint32_t x = 0, y = 0;          // lower left pixel of the region
  uint32_t region_width = 0, region_height = 0;
  double left = -1.0, right = 1.0, bottom = -1.0, top = 1.0;
  std::array<double, 8> panorama{}; // meaning depends on kind
  double clip_start = 0.0, clip_end = 0.0;
  double lens_radius = 0.0, focal_distance = 0.0;
  uint32_t aperture_blades = 0; // below 3: a round aperture
  double aperture_rotation = 0.0, aperture_ratio = 1.0;

  bool is_panorama() const { return kind > CameraKind::Orthographic; }
  // Multiplies the lengths of the scene by scale.
  void scale_lengths(double scale);

  // Returns the ray through a place on the film. raster: pixels of the full image, (0, 0) the lower left corner; lens: a point
  // of the lens from aperture(). The direction's component along the axis is 1, so that t is the depth; for panoramas, the
  // direction is unit. Outside a panorama's field of view there is no ray, and tmax is negative.
  Ray ray(const glm::dvec2 &raster, const glm::dvec2 &lens) const;
  // Returns a point of the lens, in units of its radius, for u in [0, 1)^2.
  glm::dvec2 aperture(const glm::vec2 &u) const;

  // Returns the depth of a world point as in the depth pass: along the axis, or the distance for panoramas.
  double depth(const glm::dvec3 &p) const;
  // Transforms a point or a direction to the camera's frame with z forwards, as nodes use it.
  glm::vec3 to_camera(const glm::dvec3 &p) const;
  glm::vec3 direction_to_camera(const glm::dvec3 &d) const;
  // Returns the place of a point in the picture: (0, 0) the lower left corner, (1, 1) the upper right; z is 0.
  glm::vec3 to_window(const glm::dvec3 &p) const;
};

// Radius of a pixel's footprint: base at distance 0, plus spread per unit of distance; normalised units.
struct PixelCone {
  explicit PixelCone(const Camera &camera);
  double base = 0.0, spread = 0.0;
};

// Panoramic projections between a place in the whole panorama, 0 ... 1, and a direction. Local frame: -z forwards, y up.

// Returns a unit direction; zero outside the field of view.
glm::dvec3 panorama_direction(const Camera &camera, const glm::dvec2 &place);
// d: unit. Returns its place, which may be outside the picture.
glm::dvec2 panorama_place(const Camera &camera, const glm::dvec3 &d);

} // namespace lancer
