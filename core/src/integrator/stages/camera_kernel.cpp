// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/stages/camera.h"

#include "sampling/pixel_filter.h"
#include "scene/camera.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

LANCER_LANE D to_double(U a) { return widen(to_float(a >> 16)) * D(65536.0) + widen(to_float(a & U(0xffffu))); }

[[gnu::flatten]] void rays(const Camera &camera, const FilterTable &filter, const AddressBlock &addresses, CameraBlock &rays) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    // Sample a place on the film by the pixel filter.
    const U x = load(addresses.x + first), y = load(addresses.y + first);
    const U pixel = hash_combine(hash_combine(U(addresses.key), x), y);
    store(rays.pixel + first, pixel);
    F u[kDimensionVertex];
    const uint32_t dimensions = camera.lens_radius > 0.0 ? kDimensionVertex : kDimensionLens;
    for (uint32_t i = 0; i < dimensions; ++i)
      u[i] = scrambled(load(addresses.reversed_point[i] + first), pixel, i);
    const Vector2<D> raster{(to_double(x) + D(0.5)) + widen(sample_filter(filter, u[kDimensionPixel])),
                            (to_double(y) + D(0.5)) + widen(sample_filter(filter, u[kDimensionPixel + 1]))};
    // Make the ray through that place.
    Vector2<D> lens{D(0.0), D(0.0)};
    if (camera.lens_radius > 0.0)
      lens = round_aperture(camera, u[kDimensionLens], u[kDimensionLens + 1]);
    const RayLanes<F> ray = flat_ray<F>(camera, raster, lens);
    store3(rays.o, first, ray.o);
    store3(rays.d, first, ray.d);
  }
}

} // namespace

namespace LANCER_ISA {
const CameraKernel camera_kernel = {LANCER_ISA_NAME, rays};
}

} // namespace lancer
