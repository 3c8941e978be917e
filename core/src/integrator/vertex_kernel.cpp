// Compiled once per instruction set, with LANCER_ISA naming it. This file may emit no shared (weak) symbol: see bvh_kernel.cpp.
#include "integrator/vertex_kernel.h"

#include "bsdf/wide_bsdf.h"
#include "lancer.h"

#ifndef LANCER_ISA
#define LANCER_ISA generic
#endif
#define LANCER_TEXT(x) #x
#define LANCER_NAME(x) LANCER_TEXT(x)

namespace lancer {
namespace {

// Lanes whose reflecting lobes want a normal that sends the mirrored direction above the surface: reflecting_normal().
LANCER_LANE M bent_lanes(const Records &records, const V3 &wo, const V3 &ns, const V3 &ng) {
  const M may = equal(word(
                          records, [](const WideMaterial &m) __attribute__((always_inline)) { return m.bends; }),
                      U(1u));
  const M flat = (ns.x == ng.x) & (ns.y == ng.y) & (ns.z == ng.z);
  const F cos_o = dot(wo, ng), least = min(F(0.9f) * cos_o, F(0.01f));
  const V3 mirrored = F(2.0f) * dot(ns, wo) * ns - wo;
  return may & !flat & !(dot(ng, mirrored) >= least);
}

// The power heuristic in ratio form.
LANCER_LANE F mis_weight(D pdf, D other) {
  const D ratio = other / pdf;
  return narrow(D(1.0) / (D(1.0) + ratio * ratio));
}

LANCER_LANE M has_bit(const uint32_t *words, uint32_t bit) { return !equal(load(words) & U(bit), U(0u)); }

// What the light's sample brings to the viewer where nothing is in its way.
LANCER_LANE void light(VertexBlock &block, int first, const WideBsdf &bsdf, const V3 &beta) {
  const F zero(0.0f);
  const V3 dark{zero, zero, zero};
  const D pdf = load(block.light_pdf + first);
  const WideValue value = eval_lit(bsdf, load3(block.light_wi, first));
  const uint32_t *hidden = block.light_hidden + first;
  const V3 f = select(has_bit(hidden, LANCER_RAY_DIFFUSE), dark, value.diffuse) +
               select(has_bit(hidden, LANCER_RAY_GLOSSY), dark, value.glossy);
  // The BSDF finds the same light, unless it is a single direction.
  const F weight = select(has_bit(block.light_delta + first, 1u), F(1.0f), mis_weight(pdf, widen(value.pdf)));
  const V3 contribution = beta * f * load3(block.light_radiance, first) * narrow(widen(weight) / pdf);
  const M lit = (pdf > D(0.0)) & !black(f);
  store3(block.contribution, first, contribution);
  block.lit |= bits(lit) << first;
}

[[gnu::flatten]] void shade(VertexBlock &block) {
  block.bent = block.lit = block.sampled = block.glossy = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    Records records{block.material + first, true};
    uint32_t count = 0;
    for (int i = 0; i < kLanes; ++i) {
      records.same = records.same && records.of[i] == records.of[0];
      count = records.of[i]->count > count ? records.of[i]->count : count;
    }
    const V3 wo = load3(block.wo, first), ns = load3(block.ns, first), ng = load3(block.ng, first);
    WideBsdf bsdf;
    make_bsdf(records, static_cast<int>(count), wo, ns, ng, bsdf);
    block.bent |= bits(bent_lanes(records, wo, ns, ng)) << first;
    light(block, first, bsdf, load3(block.beta, first));
    const WideSample sample =
        sample_bsdf(bsdf, load(block.u_lobe + first), load(block.u_bsdf[0] + first), load(block.u_bsdf[1] + first));
    store3(block.wi, first, sample.wi);
    store3(block.weight, first, sample.weight);
    store(block.pdf + first, sample.pdf);
    block.sampled |= bits(sample.valid) << first;
    block.glossy |= bits(sample.glossy) << first;
  }
}

} // namespace

namespace LANCER_ISA {
const VertexKernel vertex_kernel = {LANCER_NAME(LANCER_ISA), shade};
}

} // namespace lancer
