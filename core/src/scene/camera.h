// Generates a ray from a place on the film: flat projections, panoramas, the lens.
#pragma once

#include "sampling/warp.h"
#include "scene/affine.h"
#include "scene/hit_surface.h"
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

// The camera looks along its local -z, y up. The window is the whole picture's rectangle: on the plane z = -1 (perspective), at
// any depth (orthographic), or as a part of the whole panorama, which is 0 ... 1. The window includes sensor fit, shift and
// pixel aspect.
struct Camera {
  Affine to_world;
  CameraKind kind = CameraKind::Perspective;
  uint32_t width = 0, height = 0; // whole picture, pixels
  uint32_t x = 0, y = 0;          // lower left pixel of the region
  uint32_t region_width = 0, region_height = 0;
  double left = -1.0, right = 1.0, bottom = -1.0, top = 1.0;
  std::array<double, 8> panorama{}; // meaning depends on kind
  double clip_start = 0.0, clip_end = 0.0;
  double lens_radius = 0.0, focal_distance = 0.0;
  uint32_t aperture_blades = 0; // below 3: a round aperture
  double aperture_rotation = 0.0, aperture_ratio = 1.0;
  // Spherical stereo; convergence: 0 = parallel. See lancer_camera.
  double eye_offset = 0.0, convergence = 0.0, pole_merge_from = 0.0, pole_merge_to = 0.0;

  bool is_stereo() const { return eye_offset != 0.0; }
  bool is_panorama() const { return kind > CameraKind::Orthographic; }
  // Multiplies the lengths of the scene by scale.
  void scale_lengths(double scale);

  // Returns the ray through a place on the film. raster: pixels of the whole picture, (0, 0) the lower left corner; lens: a
  // point of the lens from aperture(). The direction's component along the axis is 1, so that t is the depth; for panoramas,
  // the direction is unit. Outside a panorama's field of view there is no ray, and tmax is negative.
  Ray ray(const glm::dvec2 &raster, const glm::dvec2 &lens) const;
  // Moves a ray to the eye of spherical stereo; up: the axis about which eyes turn, in the frame of the ray. d keeps its
  // length.
  void move_to_eye(const glm::dvec3 &up, glm::dvec3 &o, glm::dvec3 &d) const;
  // Returns a point of the lens, in units of its radius, for u in [0, 1)^2.
  glm::dvec2 aperture(const glm::vec2 &u) const;

  // Returns the depth of a world point as in the depth pass: along the axis, or the distance for panoramas.
  double depth(const glm::dvec3 &p) const;
  // Transforms a point or a direction to the camera's frame with z forwards, as nodes use it; and a direction from it.
  glm::vec3 to_camera(const glm::dvec3 &p) const;
  glm::vec3 direction_to_camera(const glm::dvec3 &d) const;
  glm::dvec3 direction_from_camera(const glm::dvec3 &d) const;
  // Returns the place of a point in the picture: (0, 0) the lower left corner, (1, 1) the upper right; z is 0.
  glm::vec3 to_window(const glm::dvec3 &p) const;
  // Returns the same of a point in the camera's own frame, and a direction of the world in that frame.
  glm::dvec2 window_place(const glm::dvec3 &local) const;
  glm::dvec3 to_local(const glm::dvec3 &d) const { return glm::transpose(to_world.linear) * d; }
};

// Radius of the footprint of a pixel in the middle of the picture: base at distance 0, plus spread per unit of distance;
// normalised units.
struct PixelCone {
  explicit PixelCone(const Camera &camera);
  double base = 0.0, spread = 0.0;
};
// Returns the spread of a perspective camera's pixel in direction d, relative to that in the middle; 1 for other cameras.
double relative_spread(const Camera &camera, const glm::dvec3 &d);

// The mean change of a ray's direction over a pixel, as Cycles measures it. It keeps the numbers that all rays share.
class PixelSpread {
public:
  // The camera must outlive it.
  explicit PixelSpread(const Camera &camera);
  // Returns the change in direction d; 0 for an orthographic camera.
  double operator()(const glm::dvec3 &d) const;

private:
  const Camera &camera_;
  double of_middle_ = 0.0, relative_to_ = 0.0; // the cone's spread, and the change that relative_spread() divides by
};

// Panoramic projections between a place in the whole panorama, 0 ... 1, and a direction. Local frame: -z forwards, y up.

// Returns a unit direction; zero outside the field of view.
glm::dvec3 panorama_direction(const Camera &camera, const glm::dvec2 &place);
// d: unit. Returns its place, which may be outside the picture.
glm::dvec2 panorama_place(const Camera &camera, const glm::dvec3 &d);

// Rays of flat projections, through a pinhole or a lens: F is float or lanes of it; raster places and rays are double.

// Returns a point of a round lens, in units of its radius, for u and v in [0, 1).
template <class F> LANCER_LANE Vector2<DoubleOf<F>> round_aperture(const Camera &camera, F u, F v) {
  const Vector2<F> disk = warp_disk(u, v);
  return {widen(disk.x) / DoubleOf<F>(camera.aperture_ratio), widen(disk.y)};
}

// d has any length.
template <class F> struct RayLanes { Double3Of<F> o, d; };

// See Camera::ray(); lens is read only if the camera has a lens.
template <class F>
LANCER_LANE RayLanes<F> flat_ray(const Camera &camera, const Vector2<DoubleOf<F>> &raster, const Vector2<DoubleOf<F>> &lens) {
  using D = DoubleOf<F>;
  const D x = D(camera.left) + D(camera.right - camera.left) * raster.x / D(static_cast<double>(camera.width));
  const D y = D(camera.bottom) + D(camera.top - camera.bottom) * raster.y / D(static_cast<double>(camera.height));
  Double3Of<F> o(D(0.0)), d(x, y, D(-1.0));
  if (camera.kind == CameraKind::Orthographic) {
    o = {x, y, D(0.0)};
    d = {D(0.0), D(0.0), D(-1.0)};
  }
  if (camera.lens_radius > 0.0) {
    // Aim every point of the lens at the same point of the focal plane.
    const Double3Of<F> shift(D(camera.lens_radius) * lens.x, D(camera.lens_radius) * lens.y, D(0.0));
    o = o + shift;
    d = d - shift / D(camera.focal_distance);
  }
  const MapLanes<F> to_world(camera.to_world);
  return {to_world.point(o), to_world.vector(d)};
}

} // namespace lancer
