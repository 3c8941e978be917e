// From a place on the film to a ray: perspective, orthographic, thin lens.
#pragma once

#include "accel/ray.h"
#include "scene/affine.h"

namespace lancer {

// The camera looks along its local -z, y up. The window is the full image's rectangle on the plane z = -1 (perspective) or at
// any depth (orthographic); sensor fit, shift and pixel aspect are all in it.
struct Camera {
  Affine to_world;
  bool orthographic = false;
  uint32_t width = 0, height = 0; // full image, pixels
  uint32_t x = 0, y = 0;          // lower left pixel of the region
  uint32_t region_width = 0, region_height = 0;
  double left = -1.0, right = 1.0, bottom = -1.0, top = 1.0;
  double clip_start = 0.0, clip_end = 0.0;
  double lens_radius = 0.0, focal_distance = 0.0;

  // raster: pixels of the full image, (0, 0) the lower left corner; lens: a point of the unit disk.
  // The direction's component along the axis is 1, so that t is the depth.
  Ray ray(const glm::dvec2 &raster, const glm::dvec2 &lens) const {
    const double sx = left + (right - left) * raster.x / width;
    const double sy = bottom + (top - bottom) * raster.y / height;
    glm::dvec3 o(0.0), d(sx, sy, -1.0);
    if (orthographic) {
      o = glm::dvec3(sx, sy, 0.0);
      d = glm::dvec3(0.0, 0.0, -1.0);
    }
    if (lens_radius > 0.0) {
      // Aim every point of the lens at the same point of the plane in focus.
      const glm::dvec3 shift(lens_radius * lens.x, lens_radius * lens.y, 0.0);
      o += shift;
      d -= shift / focal_distance;
    }
    Ray ray;
    ray.o = to_world.point(o);
    ray.d = to_world.vector(d);
    ray.tmin = clip_start;
    ray.tmax = clip_end;
    return ray;
  }
};

} // namespace lancer
