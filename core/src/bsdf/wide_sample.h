// Directions drawn from a WideBsdf: Bsdf::sample() for many lanes at once. For kernels only, like simd/lanes.h.
#pragma once

#include "bsdf/wide_bsdf.h"
#include "sampling/warp.h"

namespace lancer {
namespace {

LANCER_LANE V3 sample_visible(const V3 &wo, F alpha_x, F alpha_y, F u, F v) {
  const V3 w = normalize(V3{alpha_x * wo.x, alpha_y * wo.y, wo.z});
  const F s = u * (F(1.0f) + w.z), sin_theta = sqrt(max(F(0.0f), s * (F(2.0f) - s)));
  const SinCos phi = sin_cos_turn(v);
  const V3 h{sin_theta * phi.cos + w.x, sin_theta * phi.sin + w.y, (F(1.0f) - u) * (F(1.0f) + w.z)};
  return normalize(V3{alpha_x * h.x, alpha_y * h.y, h.z});
}

struct WideSample {
  V3 wi, weight; // world
  F pdf;         // 0 of a single direction
  M valid, glossy, transmitted;
};

// The lobe that each lane's direction is drawn from, with what is left of its number.
struct WidePick {
  U lobe;
  M facets, matte;
  F alpha_x, alpha_y;
  F u;
};
LANCER_LANE WidePick pick(const WideBsdf &bsdf, F u) {
  const F zero(0.0f), one(1.0f);
  M open = zero == zero;
  WidePick picked{U(~0u), !open, !open, one, one, u};
  for (int k = 0; k < bsdf.count; ++k) {
    const WideTerm &term = bsdf.terms[k];
    const M there = open & (term.probability > zero);
    const M chosen = there & (picked.u < term.probability);
    const M facets = term.facets;
    // Rounding may leave u beyond the last sum: then the last one is meant.
    picked.lobe = select(there, U(static_cast<uint32_t>(k)), picked.lobe);
    picked.facets = (picked.facets & !there) | (there & facets);
    picked.matte = (picked.matte & !there) | (there & !facets);
    if (any(facets)) {
      picked.alpha_x = select(there & facets, term.alpha_x, picked.alpha_x);
      picked.alpha_y = select(there & facets, term.alpha_y, picked.alpha_y);
    }
    picked.u = select(chosen, picked.u / term.probability, select(there, picked.u - term.probability, picked.u));
    open = open & !chosen;
  }
  picked.u = min(picked.u, F(1.0f - 0x1p-24f));
  return picked;
}

// A direction from lobes that may send light two ways or in a single direction.
struct WideDirection {
  V3 wi, weight; // local; the weight of a single direction over all probabilities
  M valid, single;
};
// mine: lanes of this lobe with wo above it; h: the facet that was drawn, mirrored: wo at that facet.
LANCER_LANE void draw_side(const WideBsdf &bsdf, const WideTerm &term, M mine, F u_side, const V3 &h, const V3 &mirrored,
                           WideDirection &direction) {
  const F zero(0.0f), one(1.0f), &eta = term.ior;
  const V3 &wo = bsdf.wo;
  // Choose the side by what the facet sends there.
  const F cos_oh = select(term.delta, wo.z, dot(wo, h));
  const WideResponse response = facet_response(term, cos_oh);
  const F share = reflected_share(response), rest = one - share;
  const M reflects = u_side < share;
  const V3 back = select(term.delta, V3{-wo.x, -wo.y, wo.z}, mirrored);
  V3 wi = back, weight = response.reflected * (term.energy / share);
  if (any(mine & !reflects)) {
    // Bend wo at the facet; where nothing is bent nothing is shadowed either.
    const V3 at_facet = (cos_oh / eta - response.cos_t) * h - wo / eta;
    const V3 bent = normalize(select(term.delta, V3{-wo.x / eta, -wo.y / eta, -response.cos_t}, at_facet));
    const V3 through = select(eta == one, -wo, bent);
    const M straight = term.delta | (abs(eta - one) < F(1e-4f));
    const F shadowing = select(straight, one, facet_g2(term, wo, through) / term.g1);
    wi = select(reflects, back, through);
    weight = select(reflects, weight, response.through * (term.energy * shadowing / rest));
  }
  const F probability = select(reflects, share, rest);
  const M single = mine & (term.delta | (term.delta_through & !reflects));
  const M right = (wi.z > zero) & reflects, left = (wi.z < zero) & !reflects;
  const M dark = black(response.reflected) & black(response.through);
  direction.wi = select(mine, wi, direction.wi);
  direction.weight = select(single, term.color * weight / term.probability, direction.weight);
  direction.single = direction.single | single;
  const M likely = term.probability * probability > zero;
  const M valid = (!dark) & (right | left) & ((!single) | likely);
  direction.valid = (direction.valid & !mine) | (mine & valid);
}

// Bsdf::sample().
LANCER_LANE WideSample sample_bsdf(const WideBsdf &bsdf, F u_lobe, F u, F v) {
  const F zero(0.0f);
  // Pick a lobe by its probability.
  const WidePick picked = pick(bsdf, u_lobe);
  const M glossy = picked.facets;

  // Draw a direction from it.
  V3 h{zero, zero, zero};
  WideDirection direction{h, h, picked.matte, zero != zero};
  if (any(picked.matte))
    direction.wi = warp_cosine_hemisphere(u, v);
  if (any(glossy)) {
    const V3 facet = sample_visible(bsdf.wo, picked.alpha_x, picked.alpha_y, u, v);
    const V3 mirrored = F(2.0f) * dot(bsdf.wo, facet) * facet - bsdf.wo;
    direction.wi = select(glossy, mirrored, direction.wi);
    h = facet;
    const M above = glossy & (bsdf.wo.z > zero);
    direction.valid = direction.valid | (above & (mirrored.z > zero));
    for (int k = 0; k < bsdf.count; ++k) {
      const WideTerm &term = bsdf.terms[k];
      if (!any(term.facets))
        continue;
      const M mine = above & equal(picked.lobe, U(static_cast<uint32_t>(k))) & (term.glass | term.delta);
      if (any(mine))
        draw_side(bsdf, term, mine, picked.u, facet, mirrored, direction);
    }
  }
  const V3 wi = direction.wi;
  const M through = wi.z < zero;
  h = select(glossy, h, half_vector(bsdf.wo, wi));
  WideSample sample;
  sample.wi = to_world(bsdf.frame, wi);
  const F cos_ng = select(bsdf.flat & !direction.single, wi.z, dot(bsdf.ng, sample.wi));
  const M valid = direction.valid & (wi.z != zero) & !((cos_ng < zero) != through);
  sample.weight = direction.weight;
  sample.pdf = zero;
  sample.valid = valid;
  // Weigh with the sum over all lobes.
  if (any(valid & !direction.single)) {
    const WideValue value = sum_terms(bsdf, wi, h, picked.lobe);
    const V3 f = value.diffuse + value.glossy + value.transmission;
    sample.weight = select(direction.single, sample.weight, f / value.pdf);
    sample.pdf = select(direction.single, zero, value.pdf);
    sample.valid = valid & (direction.single | (value.pdf > zero));
  }
  sample.valid = sample.valid & !black(sample.weight);
  sample.glossy = glossy;
  sample.transmitted = through;
  return sample;
}

} // namespace
} // namespace lancer
