// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/stages/scatter.h"

#include "integrator/stages/lobe_lanes.h"
#include "scene/hit_surface.h"

namespace lancer {
namespace {

void scatter(const ScatteringVertices &vertices, ScatterBlock &next) {
  const SurfaceBlock &surfaces = vertices.surfaces;
  const LobeBlock &lobes = vertices.lobes;
  const VertexNumbers &numbers = vertices.numbers;
  next.sampled = next.diffuse = next.transmitted = next.entered = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(lobes.used >> first))
      return;
    const Bsdf<F> &bsdf = lobes_of(lobes, first);
    const D scatters = D(1.0) - widen(load(lobes.pass + first));
    const BsdfSample<F> sample = bsdf.sample(load(numbers.of[kVertexLobe] + first), load(numbers.of[kVertexBsdf] + first),
                                             load(numbers.of[kVertexBsdf + 1] + first));
    store3(next.origin, first,
           origin_towards(load3(surfaces.p, first), load(surfaces.offset + first), widen(load3(surfaces.ng, first)),
                          D3(widen(sample.wi))));
    store3(next.wi, first, sample.wi);
    store3(next.beta, first, load3(vertices.beta, first) * (sample.weight / narrow(scatters * load(vertices.count + first))));
    store(next.pdf + first, select(sample.delta, D(0.0), widen(sample.pdf) * scatters));
    store(next.pdf_scattered + first, select(sample.delta, F(0.0f), sample.pdf));
    store(next.alpha2 + first, sample.alpha2);
    if (lobes.spreads)
      store(next.mean_alpha2 + first, sample.mean_alpha2);
    for (int component = 0; component < 2 && lobes.shares; ++component)
      store3(next.share[component], first, sample.share[component]);
    next.sampled |= placed_bits((!black(sample.weight)) & (sample.pdf > F(0.0f)), first);
    next.diffuse |= placed_bits(sample.diffuse, first);
    next.transmitted |= placed_bits(sample.transmitted, first);
    if (any(sample.entered)) {
      next.entered |= placed_bits(sample.entered, first);
      store3(next.below_color, first, sample.below_color);
      store3(next.below_radius, first, sample.below_radius);
      store(next.below_g + first, sample.below_g);
      store(next.below_ior + first, sample.below_ior);
      store(next.below_variant + first, sample.below_variant);
    }
  }
}

} // namespace

namespace LANCER_ISA {
const ScatterKernel scatter_kernel = {scatter};
}

} // namespace lancer
