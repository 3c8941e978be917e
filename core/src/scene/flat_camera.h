// Rays of flat projections, through a pinhole or a lens: F is float or lanes of it; raster places and rays are double.
#pragma once

#include "sampling/warp.h"
#include "scene/camera.h"
#include "scene/hit_surface.h"

namespace lancer {

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
