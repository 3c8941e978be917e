// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/stages/occlusion.h"

#include "integrator/stages/lobe_lanes.h"
#include "sampling/warp.h"

namespace lancer {
namespace {

// The least probability of cosine-sampled lobes; weights are at most 1 / kLeastCosine.
constexpr float kLeastCosine = 0.5f;

// Matt surfaces sample next rays from the same density as occlusion rays, the cosine, so that a next ray can replace an
// occlusion ray. The estimate is 1 minus the weight of the next ray if that ray is occluded: exactly 1 without occluders. Only
// directions above both normals are replaced, because the BSDF may discard its sample in other directions. If the direction
// sampled for occlusion is not above both normals, it gets a ray of its own.
void look(const LobeBlock &lobes, const MeanBlock &means, const ScatterBlock &next, const VertexNumbers &numbers,
          uint32_t asked_bits, bool next_rays_look, OcclusionBlock &around) {
  around.by_next = around.by_itself = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const M asked = some(asked_bits, first);
    if (!any(asked))
      continue;
    const Bsdf<F> &bsdf = lobes_of(lobes, first);
    const F zero(0.0f);
    const V3 n = load3(means.matt_normal, first);
    const V3 wi = Frame<F>(n).to_world(
        warp_cosine_hemisphere(load(numbers.of[kVertexBsdf] + first), load(numbers.of[kVertexBsdf + 1] + first)));
    store3(around.wi, first, wi);
    F cosine = zero;
    for (int i = 0; i < bsdf.count && next_rays_look; ++i) {
      const Lobe<F> &lobe = bsdf.lobes[i];
      if (draws_cosines(lobe) && !(lobe.shape == LobeShape::Matte && matte_transmits(lobe)))
        cosine += select(equal(bsdf.first_same[lobe.frame], U(0u)), lobe.probability, zero);
    }
    const M by_next = asked & (cosine >= F(kLeastCosine)) & (dot(n, bsdf.ns) > F(1.0f - 1e-6f)) & (bsdf.wo_local[0].z > zero);
    const auto above = [&](const V3 &d) __attribute__((always_inline)) {
      return (dot(d, bsdf.ns) > zero) & (dot(d, bsdf.ng) > zero);
    };
    const V3 next_wi = load3(next.wi, first);
    const F density = load(next.pdf_scattered + first);
    const M drawn = by_next & above(next_wi) & (density > zero);
    const F weight = max(dot(n, next_wi), zero) / (F(glm::pi<float>()) * density);
    store(around.weight + first, select(drawn, weight, zero));
    around.by_next |= placed_bits(drawn, first);
    around.by_itself |= placed_bits(asked & !(by_next & above(wi)), first);
  }
}

} // namespace

namespace LANCER_ISA {
const OcclusionKernel occlusion_kernel = {look};
}

} // namespace lancer
