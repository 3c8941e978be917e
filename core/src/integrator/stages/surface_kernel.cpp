// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/stages/surface.h"

#include "bsdf/material_lobes.h"
#include "integrator/stages/lobe_lanes.h"
#include "integrator/stages/lobe_means.h"
#include "scene/hit_surface.h"

#include <new>

namespace lancer {
namespace {

LANCER_LANE void store_surface(SurfaceBlock &block, int first, const SurfaceLanes<F> &surface, M lanes) {
  store3(block.p, first, lanes, surface.p);
  store(block.offset + first, lanes, surface.offset);
  store3(block.ng, first, lanes, surface.ng);
  store3(block.ns, first, lanes, surface.ns);
}

[[gnu::flatten]] void find(const HitBlock &hits, SurfaceBlock &surfaces) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(hits.used >> first))
      return;
    // wo points back along the ray.
    const D3 d = load3(hits.d, first);
    const D length = sqrt(dot(d, d));
    const D scale = D(1.0) / length;
    store(surfaces.length + first, length);
    store3(surfaces.wo, first, narrow(D3{-(d.x * scale), -(d.y * scale), -(d.z * scale)}));
    const M on_mesh = some(hits.on_mesh, first), exact = some(hits.exact, first);
    const Placements<F> placed(hits.placement + first);
    if (any(on_mesh)) {
      V3 v[3], n[3];
      for (int corner = 0; corner < 3; ++corner) {
        v[corner] = load3(hits.corner[corner], first);
        n[corner] = load3(hits.normals[corner], first);
      }
      const SurfaceLanes<F> surface =
          triangle_surface(placed, v, n, some(hits.smooth, first), load(hits.bary[0] + first), load(hits.bary[1] + first));
      store_surface(surfaces, first, surface, on_mesh);
    }
    if (any(exact)) {
      const QuadricKinds<F> kinds{some(hits.on_plane, first), some(hits.on_cylinder, first), some(hits.on_cone, first)};
      store_surface(surfaces, first, quadric_surface(placed, kinds, load3(hits.o, first), d, load(hits.t + first)), exact);
    }
  }
}

// Values of the material's nodes in every lane.
struct NodeValues {
  const MaterialBlock &block;
  int first;
  LANCER_LANE V3 operator()(const Parameter &parameter) const {
    if (!parameter.varies())
      return V3(parameter.value);
    return load3(block.values[parameter.node], first);
  }
};

// Returns the share of paths that pass straight through where each way on is at least kLeastChoice of the choices, as in Cycles
// up to 3.6. all: the weight of all ways.
LANCER_LANE F even_share(const Bsdf<F> &bsdf, F through, F all) {
  constexpr float kLeastChoice = 0.125f;
  const F least = F(kLeastChoice) * all, passing = max(through, least);
  F raised = passing;
  for (int i = 0; i < bsdf.count; ++i) {
    const F weight = select(black(bsdf.lobes[i].color), F(0.0f), mean(bsdf.lobes[i].albedo));
    raised = select(weight > F(0.0f), raised + max(weight, least), raised);
  }
  return passing / raised;
}

// Returns the share of paths that pass straight through instead of being scattered.
LANCER_LANE F share_passing(const MaterialBlock &materials, int first, const Bsdf<F> &bsdf) {
  const F zero(0.0f), through = load(materials.through + first) + mean(bsdf.straight);
  const M passes = through > zero;
  if (!any(passes))
    return zero;
  const M ends = some(materials.ends, first);
  const F all = through + select(ends, zero, mean(bsdf.albedo()));
  F share = through / all;
  if (materials.even_choices != 0)
    share = select(some(materials.even_choices, first) & !ends, even_share(bsdf, through, all), share);
  return select(passes, share, zero);
}

LANCER_LANE F widest_alpha2(const Bsdf<F> &bsdf) {
  F widest(0.0f);
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe<F> &lobe = bsdf.lobes[i];
    widest = select((lobe.probability > F(0.0f)) & !lobe.delta, max(widest, alpha2_of(lobe)), widest);
  }
  return widest;
}

LobeLimits<F> limits_of(const MaterialBlock &materials, int first) {
  LobeLimits<F> limits;
  limits.lacks_reflections = materials.no_reflections;
  limits.lacks_refractions = materials.no_refractions;
  limits.caustics = (materials.no_caustics | materials.only_caustics) != 0;
  limits.blurs = materials.blurs;
  limits.lacks = materials.lacks;
  if (limits.caustics) {
    const M lacking = some(materials.no_caustics, first), none = mask_of(0);
    limits.no_reflections = materials.no_reflections ? lacking : none;
    limits.no_refractions = materials.no_refractions ? lacking : none;
    limits.only_caustics = some(materials.only_caustics, first);
  }
  if (limits.blurs)
    limits.least_alpha = load(materials.least_alpha + first);
  return limits;
}

void build(const SurfaceBlock &surfaces, const MaterialBlock &materials, LobeBlock &lobes) {
  lobes.transmits = lobes.scatters = lobes.enters = lobes.sheets = 0;
  lobes.shares = materials.shares;
  lobes.spreads = materials.spreads;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(lobes.used >> first))
      return;
    Bsdf<F> &bsdf = *new (&lobes_of(lobes, first)) Bsdf<F>;
    bsdf.shares = materials.shares;
    bsdf.spreads = materials.spreads;
    find_lobes<F>(materials.material + first, NodeValues{materials, first}, some(materials.holes, first),
                  load3(surfaces.wo, first), load3(surfaces.ns, first), load3(surfaces.ng, first), bsdf,
                  {.seen_by_camera = some(materials.seen_by_camera, first),
                   .ends = some(materials.ends, first),
                   .after_diffuse = some(materials.after_diffuse, first),
                   .walks = materials.walks,
                   .leaving = materials.leaving,
                   .dimmed = some(materials.dimmed, first),
                   .pixel = load(materials.pixel + first),
                   .key = load(materials.key + first),
                   .limits = limits_of(materials, first)});
    store3(lobes.ns, first, bsdf.ns);
    store3(lobes.ng, first, bsdf.ng);
    store3(lobes.emission, first, bsdf.emission);
    store(lobes.pass + first, share_passing(materials, first, bsdf));
    if (const M sheets = !black(bsdf.straight); any(sheets)) {
      store3(lobes.straight, first, bsdf.straight);
      lobes.sheets |= placed_bits(sheets, first) & lobes.used;
    }
    lobes.transmits |= placed_bits(bsdf.transmits, first);
    lobes.scatters |= placed_bits(bsdf.smooth, first);
    if (materials.spreads)
      store(lobes.widest + first, widest_alpha2(bsdf));
    if (materials.walks)
      lobes.enters |= placed_bits(enters(bsdf), first) & lobes.used;
  }
}

void describe(const MaterialBlock &materials, const LobeBlock &lobes, const MeansWanted &wanted, MeanBlock &means) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(lobes.used >> first))
      return;
    const Bsdf<F> &bsdf = lobes_of(lobes, first);
    if (wanted.normal)
      store3(means.normal, first, mean_normal(bsdf));
    if (wanted.matt_normal)
      store3(means.matt_normal, first, mean_normal(bsdf, true));
    for (int component = 0; component < 3 && wanted.shown; ++component)
      store3(means.shown[component], first, bsdf.shown(static_cast<Component>(component)));
    if (!wanted.mixture)
      continue;
    const Mixture<F> mixture =
        mix(bsdf, load3(materials.transmittance, first), some(materials.ends, first), wanted.blended, wanted.bare_roughness);
    store3(means.mixed_normal, first, mixture.normal);
    store3(means.mixed_diffuse, first, mixture.diffuse);
    store3(means.mixed_specular, first, mixture.specular);
    store(means.mixed_all + first, mixture.all);
    store(means.mixed_matt + first, mixture.matt);
    store(means.mixed_roughness + first, mixture.roughness);
  }
}

} // namespace

namespace LANCER_ISA {
const SurfaceKernel surface_kernel = {find, build, describe, kBlockLanes / kLanes * sizeof(Bsdf<F>)};
}

} // namespace lancer
