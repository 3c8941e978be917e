// Compiled once per instruction set, with LANCER_ISA naming it. This file may emit no shared (weak) symbol: see bvh_kernel.cpp.
#include "integrator/vertex_kernel.h"

#include "accel/kernel_name.h"
#include "bsdf/wide_normal.h"
#include "bsdf/wide_sample.h"
#include "lancer.h"
#include "lights/light_choice.h"
#include "lights/sample_light.h"
#include "sampling/scramble.h"
#include "sampling/warp.h"
#include "scene/wide_surface.h"

namespace lancer {
namespace {

template <class Enum> LANCER_LANE U number_of(Enum value) { return U(static_cast<uint32_t>(value)); }
LANCER_LANE uint32_t placed_bits(M m, int first) { return bits(m) << first; }

// The eight numbers of the vertex.
LANCER_LANE void draw_numbers(VertexBlock &block, int first) {
  const U pixel = load(block.pixel + first);
  for (uint32_t i = 0; i < 8; i += 2) {
    const uint32_t dimension = block.dimension + i;
    Vector2<F> u;
    if (dimension < kJointDimensions)
      u = {scrambled(U(block.reversed_point[i]), pixel, dimension),
           scrambled(U(block.reversed_point[i + 1]), pixel, dimension + 1)};
    else
      u = pair_numbers(U(block.reversed_sample), pixel, dimension);
    store(block.u[i] + first, u.x);
    store(block.u[i + 1] + first, u.y);
  }
}

LANCER_LANE void store_surface(VertexBlock &block, int first, const WideSurface &surface, M lanes) {
  store3(block.p, first, lanes, surface.p);
  store(block.offset + first, lanes, surface.offset);
  store3(block.ng, first, lanes, surface.ng);
  store3(block.ns, first, lanes, surface.ns);
  block.odd |= placed_bits(surface.odd & lanes, first);
}

[[gnu::flatten]] void surfaces(VertexBlock &block) {
  block.odd = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    if (!block.numbers_given)
      draw_numbers(block, first);
    // Back along the ray.
    const D3 d = load3(block.d, first);
    const D length = sqrt(dot(d, d));
    const D scale = D(1.0) / length;
    store(block.length + first, length);
    store3(block.wo, first, narrow(D3{-(d.x * scale), -(d.y * scale), -(d.z * scale)}));
    const M on_mesh = some(block.on_mesh, first), on_plane = some(block.on_plane, first);
    const M round = some(block.on_sphere, first) | on_plane;
    const double *const *placements = block.placement + first;
    const bool same = all_same(placements);
    WideSurface surface;
    if (any(on_mesh)) {
      V3 v[3], n[3];
      for (int corner = 0; corner < 3; ++corner) {
        v[corner] = load3(block.corner[corner], first);
        n[corner] = load3(block.normal[corner], first);
      }
      surface = mesh_surface(placements, same, v, n, some(block.smooth, first), load(block.bary[0] + first),
                             load(block.bary[1] + first));
      store_surface(block, first, surface, on_mesh);
    }
    if (any(round)) {
      surface = round_surface(placements, same, load3(block.o, first), d, load(block.t + first), on_plane);
      store_surface(block, first, surface, round);
    }
  }
}

// The normal on the viewer's side.
LANCER_LANE V3 seen_normal(const VertexBlock &block, int first) {
  const V3 ns = load3(block.ns, first);
  return select(dot(load3(block.wo, first), load3(block.ng, first)) < F(0.0f), -ns, ns);
}

[[gnu::flatten]] void choose(VertexBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    const LightQueryLanes<F> query(load3(block.p, first), seen_normal(block, first), some(block.transmits, first));
    const D u = widen(load(block.u[4] + first)) + D(0x1p-24) * widen(load(block.u[7] + first));
    const LightChoiceLanes<F> choice = choose_light(query, block.light_nodes, u, mask_of((1u << kLanes) - 1u));
    store(block.chosen + first, choice.number);
    store(block.chosen_probability + first, choice.probability);
    store(block.chosen_rest + first, choice.u);
  }
}

// Samples of lamps, beside those that are given.
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
  // Dark ones are none.
  sample.pdf = select(asked & black(sample.radiance), D(0.0), sample.pdf);
  store3(block.light_target, first, sample.target);
  store3(block.light_wi, first, sample.wi);
  store3(block.light_radiance, first, sample.radiance);
  store(block.light_delta + first, select(sample.delta, U(1u), U(0u)));
  store(block.light_pdf + first, select(asked, sample.pdf * probability, sample.pdf));
}

// Lanes whose lobes mind that their normal bends.
LANCER_LANE M bent_lanes(const Records &records, const V3 &wo, const V3 &ns, const V3 &ng) {
  const M may = equal(word(
                          records, [](const WideMaterial &m) __attribute__((always_inline)) { return m.bends; }),
                      U(1u));
  return may & bends(wo, ns, ng);
}

// The power heuristic in ratio form.
LANCER_LANE F mis_weight(D pdf, D other) {
  const D ratio = other / pdf;
  return narrow(D(1.0) / (D(1.0) + ratio * ratio));
}

LANCER_LANE M has_bit(const uint32_t *words, uint32_t bit) { return !equal(load(words) & U(bit), U(0u)); }

// Where a ray towards wi leaves the surface: leave().
LANCER_LANE D3 origin(const D3 &p, D offset, const D3 &ng, const D3 &wi) {
  const D side = select(dot(ng, wi) < D(0.0), D(-1.0), D(1.0));
  return p + side * offset * ng;
}

// Whether the shadow ray may start on the curved surface: amount of terminator_offset().
LANCER_LANE M lifted(F limit, const V3 &ns, const V3 &ng, const V3 &wi) {
  const F facing = dot(ns, wi), cos_n = abs(facing), cos_g = select(facing < F(0.0f), dot(-ng, wi), dot(ng, wi));
  const F amount = select(cos_n < limit, F(2.0f) - (cos_g + cos_n) / limit, F(1.0f) - cos_g / limit);
  return (limit > F(0.0f)) & (amount > F(0.0f));
}

// Shares paths between what passes straight on and what the surface scatters.
LANCER_LANE F share_passing(VertexBlock &block, int first, const WideBsdf &bsdf) {
  const F zero(0.0f), through = load(block.through + first);
  F pass = zero;
  const M passes = through > zero;
  if (any(passes)) {
    const V3 sum = albedo(bsdf);
    const F mean = (sum.x + sum.y + sum.z) / F(3.0f);
    pass = select(passes, through / (through + select(some(block.ends, first), zero, mean)), zero);
  }
  store(block.pass + first, pass);
  return pass;
}

// What the light's sample brings to the viewer where nothing is in its way. scatters: share of paths that do not pass straight
// on: they find the same light.
LANCER_LANE void light(VertexBlock &block, int first, const WideBsdf &bsdf, const V3 &ns, const V3 &ng, D scatters) {
  const F zero(0.0f);
  const V3 dark{zero, zero, zero};
  const D pdf = load(block.light_pdf + first);
  const V3 wi = narrow(load3(block.light_wi, first));
  const WideValue value = eval_lit(bsdf, wi);
  const uint32_t *hidden = block.light_hidden + first;
  const V3 f = select(has_bit(hidden, LANCER_RAY_DIFFUSE), dark, value.diffuse) +
               select(has_bit(hidden, LANCER_RAY_GLOSSY), dark, value.glossy) +
               select(has_bit(hidden, LANCER_RAY_TRANSMISSION), dark, value.transmission);
  // The BSDF finds the same light, unless it is a single direction.
  const F weight = select(has_bit(block.light_delta + first, 1u), F(1.0f), mis_weight(pdf, widen(value.pdf) * scatters));
  // What is scattered of a density is of the order of 1, however narrow the lobe and however bright the light.
  const V3 contribution = load3(block.beta, first) * (f * narrow(widen(weight) / pdf)) * load3(block.light_radiance, first);
  store3(block.contribution, first, contribution);
  block.lit |= placed_bits((pdf > D(0.0)) & !black(f), first);
  block.lifted |= placed_bits(lifted(load(block.terminator + first), ns, ng, wi), first);
}

[[gnu::flatten]] void shade(VertexBlock &block) {
  block.lit = block.lifted = block.sampled = block.glossy = block.transmitted = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    const D3 p = load3(block.p, first);
    ask_lamps(block, first, p);
    // Look from the viewer's side.
    const V3 wo = load3(block.wo, first), out_ns = load3(block.ns, first), out_ng = load3(block.ng, first);
    const M behind = dot(wo, out_ng) < F(0.0f);
    const V3 ns = select(behind, -out_ns, out_ns), ng = select(behind, -out_ng, out_ng);
    store3(block.viewer_ns, first, ns);
    store3(block.viewer_ng, first, ng);
    Records records{block.material + first, all_same(block.material + first)};
    uint32_t count = 0;
    for (int i = 0; i < kLanes; ++i)
      count = records.of[i]->count > count ? records.of[i]->count : count;
    block.odd |= placed_bits(bent_lanes(records, wo, ns, ng), first);
    WideBsdf bsdf;
    make_bsdf(records, static_cast<int>(count), wo, ns, ng, load3(block.weight, first), load3(block.base, first), bsdf);
    // Glass of which nothing is left asks for light as other surfaces do.
    block.odd |= placed_bits(transmits(bsdf) != some(block.transmits, first), first);
    const D scatters = D(1.0) - widen(share_passing(block, first, bsdf));
    light(block, first, bsdf, ns, ng, scatters);
    const D offset = load(block.offset + first);
    const D3 outwards = widen(out_ng);
    store3(block.shadow_origin, first, origin(p, offset, outwards, load3(block.light_wi, first)));
    // Go on in a direction of the BSDF.
    const WideSample sample = sample_bsdf(bsdf, load(block.u[5] + first), load(block.u[0] + first), load(block.u[1] + first));
    store3(block.next_origin, first, origin(p, offset, outwards, widen(sample.wi)));
    store3(block.wi, first, sample.wi);
    store3(block.beta, first, load3(block.beta, first) * (sample.weight / narrow(scatters)));
    store(block.pdf + first, widen(sample.pdf) * scatters);
    block.sampled |= placed_bits(sample.valid, first);
    block.glossy |= placed_bits(sample.glossy, first);
    block.transmitted |= placed_bits(sample.transmitted, first);
  }
}

[[gnu::flatten]] uint32_t meets(const WayBlock &ways, const Light &light) {
  uint32_t met = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const D3 d = load3(ways.d, first);
    const D3 wi = d / sqrt(dot(d, d));
    met |= placed_bits(may_meet(OneLight<F>{light}, load3(ways.from, first), wi, load(ways.end + first)), first);
  }
  return met;
}

} // namespace

namespace LANCER_ISA {
const VertexKernel vertex_kernel = {LANCER_ISA_NAME, surfaces, choose, shade, meets};
}

} // namespace lancer
