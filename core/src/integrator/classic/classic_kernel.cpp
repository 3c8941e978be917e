// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/classic/classic_kernel.h"

#include "integrator/classic/classic_terms.h"
#include "integrator/stages/block_lobes.h"
#include "integrator/stages/terminator.h"
#include "lancer.h"
#include "lights/sample_light.h"
#include "scene/hit_surface.h"
#include "simd/kernel_choice.h"

namespace lancer {
namespace {

void branch(VertexBlock &block) {
  block.mirrors = block.refracts = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    const Bsdf<F> &bsdf = lobes_of(block, first);
    const Branches<F> branches = find_branches(bsdf);
    store3(block.reflected, first, branches.reflected);
    store3(block.refracted, first, branches.refracted);
    store3(block.wi, first, branches.mirrored);
    store3(block.through_wi, first, branches.through);
    // With an interpolated normal, a mirrored direction may point into the surface: such a ray is black.
    block.mirrors |= placed_bits(dot(branches.mirrored, bsdf.ng) > F(0.0f), first);
    block.refracts |= placed_bits(dot(branches.through, bsdf.ng) < F(0.0f), first);
  }
}

// Samples the lamp, or reads the sample that the block already has.
LANCER_LANE LightSampleLanes<F> ask(VertexBlock &block, int first, const Light *lamp) {
  LightSampleLanes<F> sample;
  sample.wi = load3(block.light_wi, first);
  sample.target = load3(block.light_target, first);
  sample.radiance = load3(block.light_radiance, first);
  sample.pdf = load(block.light_pdf + first);
  sample.distance = D(0.0);
  sample.delta = mask_of(0);
  if (!lamp)
    return sample;
  sample_light(OneLight<F>{*lamp}, load3(block.p, first), load(block.u[2] + first), load(block.u[3] + first),
               some(block.used, first), sample);
  store3(block.light_wi, first, sample.wi);
  store3(block.light_target, first, sample.target);
  return sample;
}

void illuminate(VertexBlock &block, const Light *lamp, uint32_t hidden_from) {
  constexpr ClassicLight plain;
  const ClassicLight &light = lamp ? lamp->classic : plain;
  block.lit = block.lifted = block.there = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    const Bsdf<F> &bsdf = lobes_of(block, first);
    const LightSampleLanes<F> sample = ask(block, first, lamp);
    const M there = some(block.used, first) & (sample.pdf > D(0.0));
    if (!any(there))
      continue;
    const V3 wi = narrow(sample.wi), irradiance = classic_irradiance(light, sample);
    const V3 sum = select(there, classic_illumination(bsdf, wi, light, irradiance, hidden_from), Vec3<F>(F(0.0f)));
    store3(block.irradiance, first, irradiance);
    store3(block.contribution, first, sum);
    block.there |= placed_bits(there, first);
    // The lamp has to be on the viewer's side of the surface.
    block.lit |= placed_bits((dot(wi, bsdf.ng) > F(0.0f)) & !black(sum), first);
    block.lifted |= placed_bits(terminator_amount(load(block.terminator + first), bsdf.ns, bsdf.ng, wi) > F(0.0f), first);
    store3(block.shadow_origin, first,
           origin_towards(load3(block.p, first), load(block.offset + first), widen(load3(block.ng, first)), sample.wi));
  }
}

} // namespace

namespace LANCER_ISA {
const ClassicKernel classic_kernel = {branch, illuminate};
}

} // namespace lancer
