// Compiled once per instruction set, with LANCER_ISA naming it. This file may emit no shared (weak) symbol: see bvh_kernel.cpp.
#include "integrator/stages/camera_kernel.h"

#include "sampling/pixel_filter.h"
#include "sampling/scramble.h"
#include "sampling/warp.h"
#include "scene/camera.h"
#include "simd/kernel_choice.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// Affine::vector(), the columns as they stand in memory.
LANCER_LANE D3 turn(const double *m, const D3 &v) {
  return {D(m[0]) * v.x + D(m[3]) * v.y + D(m[6]) * v.z, D(m[1]) * v.x + D(m[4]) * v.y + D(m[7]) * v.z,
          D(m[2]) * v.x + D(m[5]) * v.y + D(m[8]) * v.z};
}

LANCER_LANE D to_double(U a) { return widen(to_float(a >> 16)) * D(65536.0) + widen(to_float(a & U(0xffffu))); }

[[gnu::flatten]] void rays(CameraBlock &block) {
  const Camera &camera = *block.camera;
  const double *placement = reinterpret_cast<const double *>(&camera.to_world);
  for (int first = 0; first < kCameraLanes; first += kLanes) {
    // Draw a place of the film by the pixel's filter.
    const U x = load(block.x + first), y = load(block.y + first);
    const U pixel = hash_combine(hash_combine(load(block.key + first), x), y);
    store(block.pixel + first, pixel);
    F u[4];
    const uint32_t dimensions = camera.lens_radius > 0.0 ? 4 : 2;
    for (uint32_t i = 0; i < dimensions; ++i)
      u[i] = scrambled(load(block.reversed_point[i] + first), pixel, i);
    const D raster_x = (to_double(x) + D(0.5)) + widen(sample_filter(*block.filter, u[0]));
    const D raster_y = (to_double(y) + D(0.5)) + widen(sample_filter(*block.filter, u[1]));
    const D place_x = D(camera.left) + D(camera.right - camera.left) * raster_x / D(double(camera.width));
    const D place_y = D(camera.bottom) + D(camera.top - camera.bottom) * raster_y / D(double(camera.height));
    // Look through it.
    D3 o{D(0.0), D(0.0), D(0.0)}, d{place_x, place_y, D(-1.0)};
    if (camera.kind == CameraKind::Orthographic) {
      o = {place_x, place_y, D(0.0)};
      d = {D(0.0), D(0.0), D(-1.0)};
    }
    if (camera.lens_radius > 0.0) {
      // Aim every point of the lens at the same point of the plane in focus.
      const Vector2<F> lens = warp_disk(u[2], u[3]);
      const D3 shift{D(camera.lens_radius) * (widen(lens.x) / D(camera.aperture_ratio)), D(camera.lens_radius) * widen(lens.y),
                     D(0.0)};
      o = o + shift;
      d = d - shift / D(camera.focal_distance);
    }
    store3(block.o, first, turn(placement, o) + D3{D(placement[9]), D(placement[10]), D(placement[11])});
    store3(block.d, first, turn(placement, d));
  }
}

} // namespace

namespace LANCER_ISA {
const CameraKernel camera_kernel = {LANCER_ISA_NAME, rays};
}

} // namespace lancer
