// Compiled once per instruction set, with LANCER_ISA naming it. This file may emit no shared (weak) symbol: see bvh_kernel.cpp.
#include "integrator/picture_kernel.h"

#include "accel/kernel_name.h"
#include "lights/wide_directions.h"

namespace lancer {
namespace {

[[gnu::flatten]] void sample_sky(VertexBlock &block, const WideSky &sky, uint32_t lanes) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const M which = some(lanes, first);
    if (!any(which))
      continue;
    const DirectionSample<F> found = sample_direction(sky.map, load(block.u[2] + first), load(block.u[3] + first));
    const D3 wi = found.direction;
    D pdf = found.pdf * load(block.light_pdf + first);
    if (sky.image.texels) {
      const V3 d = narrow(wi);
      const V3 radiance = picture_at(sky, d, place_of(d));
      store3(block.light_radiance, first, which, radiance);
      // What is dark is no sample.
      pdf = select(black(radiance), D(0.0), pdf);
    }
    store3(block.light_wi, first, which, wi);
    store(block.light_pdf + first, which, pdf);
  }
}

[[gnu::flatten]] void look_at_sky(SkyBlock &block, const WideSky &sky) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const V3 d = narrow(load3(block.wi, first));
    const MapPlace<D> place = place_of(d);
    store(block.pdf + first, direction_pdf<F>(sky.map, place));
    if (sky.image.texels)
      store3(block.radiance, first, picture_at(sky, d, place));
  }
}

[[gnu::flatten]] void look_up(ColorBlock &block, const WideImage &image, uint32_t lanes) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const M which = some(lanes, first);
    if (!any(which))
      continue;
    const Texel<F> found = look_up(image, load(block.uv[0] + first), load(block.uv[1] + first));
    store3(block.color, first, which, found.color);
    store(block.alpha + first, which, found.alpha);
  }
}

} // namespace

namespace LANCER_ISA {
const PictureKernel picture_kernel = {LANCER_ISA_NAME, sample_sky, look_at_sky, look_up};
}

} // namespace lancer
