// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/stages/vertex_kernel.h"

#include "compile/material_lobes.h"
#include "integrator/stages/block_lobes.h"
#include "integrator/stages/draw_numbers.h"
#include "integrator/stages/lobe_means.h"
#include "integrator/stages/terminator.h"
#include "lancer.h"
#include "lights/light_choice.h"
#include "lights/sample_light.h"
#include "sampling/warp.h"
#include "scene/hit_surface.h"
#include "simd/kernel_choice.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

template <class Enum> LANCER_LANE U number_of(Enum value) { return U(static_cast<uint32_t>(value)); }

[[gnu::flatten]] void draw(VertexBlock &block, uint32_t wanted) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    draw_numbers(block, first, wanted);
  }
}

LANCER_LANE void store_surface(VertexBlock &block, int first, const SurfaceLanes<F> &surface, M lanes) {
  store3(block.p, first, lanes, surface.p);
  store(block.offset + first, lanes, surface.offset);
  store3(block.ng, first, lanes, surface.ng);
  store3(block.ns, first, lanes, surface.ns);
}

[[gnu::flatten]] void surfaces(VertexBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    // wo points back along the ray.
    const D3 d = load3(block.d, first);
    const D length = sqrt(dot(d, d));
    const D scale = D(1.0) / length;
    store(block.length + first, length);
    store3(block.wo, first, narrow(D3{-(d.x * scale), -(d.y * scale), -(d.z * scale)}));
    const M on_mesh = some(block.on_mesh, first), exact = some(block.exact, first);
    const Placements<F> placed(block.placement + first);
    if (any(on_mesh)) {
      V3 v[3], n[3];
      for (int corner = 0; corner < 3; ++corner) {
        v[corner] = load3(block.corner[corner], first);
        n[corner] = load3(block.normals[corner], first);
      }
      const SurfaceLanes<F> surface =
          triangle_surface(placed, v, n, some(block.smooth, first), load(block.bary[0] + first), load(block.bary[1] + first));
      store_surface(block, first, surface, on_mesh);
    }
    if (any(exact)) {
      const QuadricKinds<F> kinds{some(block.on_plane, first), some(block.on_cylinder, first), some(block.on_cone, first)};
      store_surface(block, first, quadric_surface(placed, kinds, load3(block.o, first), d, load(block.t + first)), exact);
    }
  }
}

[[gnu::flatten]] void choose(VertexBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    const LightQueryLanes<F> query(load3(block.p, first), load3(block.viewer_ns, first), some(block.transmits, first));
    const D u = widen(load(block.u[4] + first)) + D(0x1p-24) * widen(load(block.u[7] + first));
    const LightChoiceLanes<F> choice = choose_light(query, block.light_nodes, u, mask_of((1u << kLanes) - 1u));
    store(block.chosen + first, choice.number);
    store(block.chosen_probability + first, choice.probability);
    store(block.chosen_rest + first, choice.u);
  }
}

// Samples lamps in the lanes that request it; the other lanes keep their samples.
LANCER_LANE void ask_lamps(VertexBlock &block, int first, const D3 &p) {
  const M asked = some(block.asked, first);
  if (!any(asked))
    return;
  LightSampleLanes<F> sample;
  sample.target = load3(block.light_target, first);
  sample.wi = load3(block.light_wi, first);
  sample.radiance = load3(block.light_radiance, first);
  sample.delta = !equal(load(block.light_delta + first), U(0u));
  const D probability = load(block.light_pdf + first);
  sample.pdf = probability;
  sample_light(EachLight<F>{block.lamp + first}, p, load(block.u[2] + first), load(block.u[3] + first), asked, sample);
  // A sample of a black light counts as no sample.
  sample.pdf = select(asked & black(sample.radiance), D(0.0), sample.pdf);
  store3(block.light_target, first, sample.target);
  store3(block.light_wi, first, sample.wi);
  store3(block.light_radiance, first, sample.radiance);
  store(block.light_delta + first, select(sample.delta, U(1u), U(0u)));
  store(block.light_pdf + first, select(asked, sample.pdf * probability, sample.pdf));
}

LANCER_LANE M has_bit(const uint32_t *words, uint32_t bit) { return !equal(load(words) & U(bit), U(0u)); }

// Values of the material's nodes in every lane.
struct NodeValues {
  const VertexBlock &block;
  int first;
  LANCER_LANE V3 operator()(const Parameter &parameter) const {
    if (!parameter.varies())
      return V3(parameter.value);
    return load3(block.values[parameter.node], first);
  }
};

void lobes(VertexBlock &block) {
  block.inside = block.transmits = block.scatters = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    Bsdf<F> &bsdf = *new (&lobes_of(block, first)) Bsdf<F>;
    bsdf.shares = block.shares_wanted != 0;
    find_lobes<F>(block.material + first, NodeValues{block, first}, some(block.holes, first), load3(block.wo, first),
                  load3(block.ns, first), load3(block.ng, first), bsdf);
    store3(block.viewer_ns, first, bsdf.ns);
    store3(block.viewer_ng, first, bsdf.ng);
    store3(block.emission, first, bsdf.emission);
    block.inside |= placed_bits(bsdf.inside, first);
    block.transmits |= placed_bits(bsdf.transmits, first);
    block.scatters |= placed_bits(bsdf.smooth, first);
  }
}

void describe(VertexBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    const Bsdf<F> &bsdf = lobes_of(block, first);
    if (block.wants_normal)
      store3(block.normal, first, mean_normal(bsdf));
    if (block.wants_matt_normal)
      store3(block.matt_normal, first, mean_normal(bsdf, true));
    for (int component = 0; component < 3 && block.wants_shown; ++component)
      store3(block.shown[component], first, bsdf.shown(static_cast<Component>(component)));
    if (!block.wants_mixture)
      continue;
    const Mixture<F> mixture = mix(bsdf, load3(block.transmittance, first), some(block.ends, first), block.blended != 0);
    store3(block.mixed_normal, first, mixture.normal);
    store3(block.mixed_diffuse, first, mixture.diffuse);
    store3(block.mixed_specular, first, mixture.specular);
    store(block.mixed_all + first, mixture.all);
    store(block.mixed_matt + first, mixture.matt);
  }
}

// Returns the share of paths that pass straight through instead of being scattered.
LANCER_LANE F share_passing(VertexBlock &block, int first, const Bsdf<F> &bsdf) {
  const F zero(0.0f), through = load(block.through + first);
  F pass = zero;
  const M passes = through > zero;
  if (any(passes))
    pass = select(passes, through / (through + select(some(block.ends, first), zero, mean(bsdf.albedo()))), zero);
  store(block.pass + first, pass);
  return pass;
}

// Returns a / b, and 0 where b is 0.
LANCER_LANE V3 divided(const V3 &a, const V3 &b) {
  const F zero(0.0f);
  return {select(b.x != zero, a.x / b.x, zero), select(b.y != zero, a.y / b.y, zero), select(b.z != zero, a.z / b.z, zero)};
}

// Computes the contribution of the light sample without occlusion. scatters: share of paths that are scattered; only these can
// find the same light by a BSDF sample.
LANCER_LANE void light_of(VertexBlock &block, int first, const Bsdf<F> &bsdf, D scatters) {
  const F zero(0.0f);
  const D pdf = load(block.light_pdf + first);
  const M lit = (pdf > D(0.0)) & some(block.scatters, first);
  if (!any(lit))
    return;
  const V3 wi = narrow(load3(block.light_wi, first));
  // In the order of Component.
  const M hidden[3] = {has_bit(block.light_hidden + first, LANCER_RAY_DIFFUSE),
                       has_bit(block.light_hidden + first, LANCER_RAY_GLOSSY),
                       has_bit(block.light_hidden + first, LANCER_RAY_TRANSMISSION)};
  const bool hides = any(hidden[0] | hidden[1] | hidden[2]);
  const BsdfValue<F> value = bsdf.eval_lit(wi, kAllShapes, hides ? hidden : nullptr);
  const V3 f = value.f();
  // BSDF samples find the same light, unless it is a single direction. The weights count one sample of each technique even
  // where samples split, as in Cycles. The count matters: with interpolated normals, the two techniques do not find the same
  // light, so that the weights change the picture.
  const F weight = select(has_bit(block.light_delta + first, 1u), F(1.0f), mis_weight(pdf, widen(value.pdf) * scatters));
  // f over a density is of the order of 1, however narrow the lobe and however bright the light.
  const V3 contribution = load3(block.beta, first) * (f * narrow(widen(weight) / (pdf * load(block.lights + first)))) *
                          load3(block.light_radiance, first);
  store3(block.contribution, first, contribution);
  for (int component = 0; component < 2 && block.shares_wanted; ++component)
    store3(block.light_share[component], first, divided(value.part[component], f));
  block.lit |= placed_bits(lit & !black(f), first);
  block.lifted |= placed_bits(terminator_amount(load(block.terminator + first), bsdf.ns, bsdf.ng, wi) > zero, first);
}

// Ambient occlusion. Matt surfaces sample next rays from the same density as occlusion rays, the cosine, so that a next ray can
// replace an occlusion ray. The estimate is 1 minus the weight of the next ray if that ray is occluded: exactly 1 without
// occluders. Only directions above both normals are replaced, because the BSDF may discard its sample in other directions. If
// the direction sampled for occlusion is not above both normals, it gets a ray of its own.
LANCER_LANE void look_around(VertexBlock &block, int first, const Bsdf<F> &bsdf, const BsdfSample<F> &sample) {
  // The least probability of cosine-sampled lobes; weights are at most 1 / kLeastCosine.
  constexpr float kLeastCosine = 0.5f;
  const M asked = some(block.occlusion_asked, first);
  if (!any(asked))
    return;
  const F zero(0.0f);
  const V3 n = load3(block.matt_normal, first);
  const V3 wi = Frame<F>(n).to_world(warp_cosine_hemisphere(load(block.u[0] + first), load(block.u[1] + first)));
  store3(block.occlusion_wi, first, wi);
  F cosine = zero;
  for (int i = 0; i < bsdf.count && block.next_rays_look; ++i) {
    const Lobe<F> &lobe = bsdf.lobes[i];
    if (draws_cosines(lobe) && !(lobe.shape == LobeShape::Matte && matte_transmits(lobe)))
      cosine += select(equal(bsdf.first_same[lobe.frame], U(0u)), lobe.probability, zero);
  }
  const M by_next = asked & (cosine >= F(kLeastCosine)) & (dot(n, bsdf.ns) > F(1.0f - 1e-6f)) & (bsdf.wo_local[0].z > zero);
  const auto above = [&](const V3 &d) __attribute__((always_inline)) {
    return (dot(d, bsdf.ns) > zero) & (dot(d, bsdf.ng) > zero);
  };
  const M drawn = by_next & above(sample.wi) & !sample.delta & (sample.pdf > zero);
  const F weight = max(dot(n, sample.wi), zero) / (F(glm::pi<float>()) * sample.pdf);
  store(block.occlusion_weight + first, select(drawn, weight, zero));
  block.looks_by_next |= placed_bits(drawn, first);
  block.looks_itself |= placed_bits(asked & !(by_next & above(wi)), first);
}

void light(VertexBlock &block) {
  block.lit = block.lifted = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    const Bsdf<F> &bsdf = lobes_of(block, first);
    const D3 p = load3(block.p, first), outwards = widen(load3(block.ng, first));
    ask_lamps(block, first, p);
    light_of(block, first, bsdf, D(1.0) - widen(share_passing(block, first, bsdf)));
    store3(block.shadow_origin, first, origin_towards(p, load(block.offset + first), outwards, load3(block.light_wi, first)));
  }
}

void scatter(VertexBlock &block) {
  block.sampled = block.diffuse = block.transmitted = 0;
  block.looks_by_next = block.looks_itself = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    const Bsdf<F> &bsdf = lobes_of(block, first);
    const D3 p = load3(block.p, first), outwards = widen(load3(block.ng, first));
    const D offset = load(block.offset + first);
    const D scatters = D(1.0) - widen(load(block.pass + first));
    // Sample the next direction from the BSDF.
    const BsdfSample<F> sample = bsdf.sample(load(block.u[5] + first), load(block.u[0] + first), load(block.u[1] + first));
    store3(block.next_origin, first, origin_towards(p, offset, outwards, D3(widen(sample.wi))));
    store3(block.wi, first, sample.wi);
    store3(block.next_beta, first, load3(block.beta, first) * (sample.weight / narrow(scatters * load(block.paths + first))));
    store(block.pdf + first, select(sample.delta, D(0.0), widen(sample.pdf) * scatters));
    store(block.alpha2 + first, sample.alpha2);
    for (int component = 0; component < 2 && block.shares_wanted; ++component)
      store3(block.share[component], first, sample.share[component]);
    look_around(block, first, bsdf, sample);
    block.sampled |= placed_bits((!black(sample.weight)) & (sample.pdf > F(0.0f)), first);
    block.diffuse |= placed_bits(sample.diffuse, first);
    block.transmitted |= placed_bits(sample.transmitted, first);
  }
}

[[gnu::flatten]] uint32_t meets(const SegmentBlock &segments, const Light &light) {
  uint32_t met = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const D3 d = load3(segments.d, first);
    const D3 wi = d / sqrt(dot(d, d));
    met |= placed_bits(may_meet(OneLight<F>{light}, load3(segments.from, first), wi, load(segments.end + first)), first);
  }
  return met;
}

[[gnu::flatten]] void meet(const SegmentBlock &segments, const Light &light, const LightNodes &tree, uint32_t place,
                           MetLight &met) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const D3 from = load3(segments.from, first), d = load3(segments.d, first);
    const LightHitLanes<F> hit = meet_light(OneLight<F>{light}, from, D3(d / sqrt(dot(d, d))));
    store(met.pdf + first, hit.pdf);
    store(met.distance + first, hit.distance);
    store3(met.radiance, first, hit.radiance);
    const LightQueryLanes<F> query(from, load3(segments.normal, first), some(segments.transmits, first));
    store(met.chosen + first, choice_probability(query, tree, place));
  }
}

} // namespace

namespace LANCER_ISA {
const VertexKernel vertex_kernel = {surfaces, lobes,   describe, draw, choose,
                                    light,    scatter, meets,    meet, kBlockLanes / kLanes * sizeof(Bsdf<F>)};
}

} // namespace lancer
