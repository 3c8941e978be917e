// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/classic/classic.h"

#include "integrator/classic/illumination.h"
#include "integrator/stages/lobe_lanes.h"
#include "integrator/stages/terminator.h"
#include "scene/hit_surface.h"

namespace lancer {
namespace {

void branch(const LobeBlock &lobes, BranchBlock &block) {
  block.mirrors = block.refracts = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(lobes.used >> first))
      return;
    const Bsdf<F> &bsdf = lobes_of(lobes, first);
    const Branches<F> branches = find_branches(bsdf);
    store3(block.reflected, first, branches.reflected);
    store3(block.refracted, first, branches.refracted);
    store3(block.mirrored, first, branches.mirrored);
    store3(block.through, first, branches.through);
    // With an interpolated normal, a mirrored direction may point into the surface: such a ray is black.
    block.mirrors |= placed_bits(dot(branches.mirrored, bsdf.ng) > F(0.0f), first);
    block.refracts |= placed_bits(dot(branches.through, bsdf.ng) < F(0.0f), first);
  }
}

// Prepares shadow rays of the lanes whose lamp is on the viewer's side of the surface.
LANCER_LANE void aim_lanes(const SurfaceBlock &surfaces, const LobeBlock &lobes, const D3 &towards, M there, int first,
                           LitBlock &lit) {
  const V3 wi = narrow(towards), ns = load3(lobes.ns, first), ng = load3(lobes.ng, first);
  lit.lit |= placed_bits((dot(wi, ng) > F(0.0f)) & there, first);
  lit.lifted |= placed_bits(terminator_amount(load(surfaces.terminator + first), ns, ng, wi) > F(0.0f), first);
  store3(lit.origin, first,
         origin_towards(load3(surfaces.p, first), load(surfaces.offset + first), widen(load3(surfaces.ng, first)), towards));
}

void illuminate(const SurfaceBlock &surfaces, const LobeBlock &lobes, const LightSamples &samples, const ClassicLight &light,
                uint32_t hidden_from, LitBlock &lit, IrradianceBlock &irradiance) {
  lit.lit = lit.lifted = irradiance.there = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(lobes.used >> first))
      return;
    LightSampleLanes<F> sample;
    sample.wi = load3(samples.wi, first);
    sample.radiance = load3(samples.radiance, first);
    sample.distance = load(samples.distance + first);
    sample.pdf = load(samples.pdf + first);
    const M there = some(lobes.used, first) & (sample.pdf > D(0.0));
    if (!any(there))
      continue;
    const Bsdf<F> &bsdf = lobes_of(lobes, first);
    const V3 wi = narrow(sample.wi), at_normal_incidence = classic_irradiance(light, sample);
    const V3 sum = select(there, classic_illumination(bsdf, wi, light, at_normal_incidence, hidden_from), Vec3<F>(F(0.0f)));
    store3(irradiance.irradiance, first, at_normal_incidence);
    store3(lit.contribution, first, sum);
    irradiance.there |= placed_bits(there, first);
    aim_lanes(surfaces, lobes, sample.wi, there & !black(sum), first, lit);
  }
}

void aim(const SurfaceBlock &surfaces, const LobeBlock &lobes, const LightSamples &samples, LitBlock &lit) {
  lit.lit = lit.lifted = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes)
    if (const M there = some(lobes.used, first) & (load(samples.pdf + first) > D(0.0)); any(there))
      aim_lanes(surfaces, lobes, load3(samples.wi, first), there, first, lit);
}

} // namespace

namespace LANCER_ISA {
const ClassicKernel classic_kernel = {branch, illuminate, aim};
}

} // namespace lancer
