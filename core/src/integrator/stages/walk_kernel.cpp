// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/stages/walk.h"

#include "bsdf/subsurface.h"
#include "sampling/sobol.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// After this number of steps a walk scatters evenly, in the medium that blurs alike.
constexpr uint32_t kDirectedSteps = 9;
// Share of even walks that is guided.
constexpr float kGuidedEven = 0.75f;
// A walk looks for the other side of its object within this number of mean free paths.
constexpr float kNearOpposite = 10.0f;
// Throughput below which a walk ends, and the largest number of steps, as in Cycles.
constexpr float kFaintest = 1e-6f;
constexpr uint32_t kMostSteps = 256;

enum Number : uint32_t { kChannel, kDistance, kStrategy, kSide, kCosine, kTurn, kNumbers };

// Random numbers of the lanes' current steps.
struct Numbers {
  U key;
  LANCER_LANE F operator()(Number number) const {
    return to_float(hash_combine(key, U(static_cast<uint32_t>(number))) >> 8) * F(0x1p-24f);
  }
};
LANCER_LANE Numbers numbers_of(const WalkBlock &block, int first) {
  const U sample =
      hash_combine(hash_combine(load(block.pixel + first), load(block.sample + first)), load(block.dimension + first));
  return {hash_combine(sample, load(block.steps + first))};
}

// The medium of a lane's current step.
struct Step {
  V3 sigma_t, sigma_s;
  F g, guided; // guided: probability of a direction towards the surface
};
LANCER_LANE Step step_of(const WalkBlock &block, int first) {
  const F one(1.0f), given = load(block.g + first);
  const V3 sigma_t = load3(block.sigma_t, first), sigma_s = sigma_t * load3(block.albedo, first);
  const M even = to_float(load(block.steps + first)) > F(static_cast<float>(kDirectedSteps));
  const V3 alike = sigma_s * (one - given);
  Step step;
  step.sigma_t = select(even, sigma_t - sigma_s + alike, sigma_t);
  step.sigma_s = select(even, alike, sigma_s);
  step.g = select(even, F(0.0f), given);
  const F directed = one - max(F(0.5f), pow(abs(given), F(0.125f)));
  step.guided = select(even, F(kGuidedEven), select(given == F(0.0f), F(0.5f), directed));
  return step;
}

LANCER_LANE F smallest(const V3 &v) { return min(min(v.x, v.y), v.z); }
LANCER_LANE F largest_of_three(const V3 &v) { return max(max(v.x, v.y), v.z); }
LANCER_LANE V3 faded(const V3 &sigma, F t) { return {exp(-sigma.x * t), exp(-sigma.y * t), exp(-sigma.z * t)}; }

void medium(WalkBlock &block, uint32_t lanes) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const M now = some(lanes, first);
    if (!any(now))
      continue;
    V3 beta = load3(block.beta, first), sigma_t(F(1.0f)), albedo(F(0.5f));
    const V3 color = load3(block.color, first), radius = load3(block.radius, first), before = beta;
    const F g = load(block.g + first);
    const U method = load(block.method + first);
    for (const auto which : {SubsurfaceMethod::RandomWalkLegacy, SubsurfaceMethod::Skin, SubsurfaceMethod::RandomWalk}) {
      const M mine = now & equal(method, U(static_cast<uint32_t>(which)));
      if (!any(mine))
        continue;
      Vec3<F> weight = before;
      const Medium<F> found = medium_below<F>(which, color, radius, g, weight);
      sigma_t = select(mine, V3(found.sigma_t), sigma_t);
      albedo = select(mine, V3(found.albedo), albedo);
      beta = select(mine, V3(weight), beta);
    }
    const F v = diffusion_length(largest_of_three(albedo));
    store3(block.sigma_t, first, now, sigma_t);
    store3(block.albedo, first, now, albedo);
    // A medium without depth absorbs all.
    store3(block.beta, first, now, select(v > F(1.0f), beta, V3(F(0.0f))));
    store(block.length + first, now, v);
    store(block.log_length + first, now, log((v + F(1.0f)) / max(v - F(1.0f), F(0x1p-100f))));
  }
}

void step(WalkBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!any(some(block.walking, first)))
      continue;
    const F zero(0.0f), one(1.0f);
    const Numbers random = numbers_of(block, first);
    const Step of = step_of(block, first);
    const M is_first = equal(load(block.steps + first), U(0u));

    // Choose the channel that decides the distance, by the light that it still scatters.
    const V3 beta = load3(block.beta, first), albedo = load3(block.albedo, first);
    const V3 share = abs(beta * albedo);
    const F sum = share.x + share.y + share.z;
    const V3 channel = select(sum > zero, share / sum, V3(F(1.0f / 3.0f)));
    const F u = random(kChannel);
    const M red = u < channel.x, green = (!red) & (u < channel.x + channel.y);
    F sigma = select(red, of.sigma_t.x, select(green, of.sigma_t.y, of.sigma_t.z));

    // Sample the direction: that of entry, by the phase function, or towards the surface, the near one or the opposite.
    const V3 n = load3(block.n, first);
    V3 d = load3(block.d, first);
    F forward = zero, backward = zero, stretch = zero, share_back = zero;
    if (!all(is_first)) {
      const F v = load(block.length + first), log_v = load(block.log_length + first), opposite = load(block.opposite + first);
      const M has_opposite = opposite > zero, guided = random(kStrategy) < of.guided;
      const D3 way = load3(block.p, first) - load3(block.begin, first);
      const F depth = min(max(-narrow(dot(way, widen(n))), zero), opposite);
      share_back = select(has_opposite, one / (one + exp((opposite - F(2.0f) * depth) / v)), zero);
      const M back = guided & has_opposite & (random(kSide) < share_back);
      const F by_guide = dwivedi_sample(v, log_v, random(kCosine)), cosine_guided = select(back, -by_guide, by_guide);
      const V3 to_surface = around(n, cosine_guided, random(kTurn));
      const V3 by_phase = around(d, henyey_greenstein_sample(of.g, random(kCosine)), random(kTurn));
      const V3 next = select(guided, to_surface, by_phase);
      const F cosine = select(guided, cosine_guided, dot(next, n));
      // Ratios of the guided densities to that of the phase function; the distance is stretched or shortened alike.
      const F phase = henyey_greenstein(dot(d, next), of.g);
      forward = F(0.5f * kInvPi) * dwivedi_pdf(v, log_v, cosine) / phase;
      backward = F(0.5f * kInvPi) * dwivedi_pdf(v, log_v, -cosine) / phase;
      stretch = cosine / v;
      sigma = select(is_first, sigma, sigma * select(guided, select(back, one + stretch, one - stretch), one));
      d = select(is_first, d, next);
    }
    const F t = -log1p(-random(kDistance)) / sigma;
    store3(block.d, first, d);
    store3(block.channel, first, channel);
    store(block.forward + first, forward);
    store(block.backward + first, backward);
    store(block.stretch + first, stretch);
    store(block.backward_share + first, share_back);
    store(block.t + first, widen(t));
    store(block.reach + first, widen(select(is_first, max(t, F(kNearOpposite) / smallest(of.sigma_t)), t)));
  }
}

void advance(WalkBlock &block) {
  uint32_t going = 0, left = 0;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const M walking = some(block.walking, first);
    if (!any(walking))
      continue;
    const F zero(0.0f), one(1.0f);
    const Step of = step_of(block, first);
    const U steps = load(block.steps + first);
    const M is_first = equal(steps, U(0u));
    const D wanted = load(block.t + first), met = load(block.met + first);
    const M hits = met < wanted;
    const D travelled = select(hits, met, wanted);
    const F t = narrow(travelled);
    const V3 n = load3(block.n, first), d = load3(block.d, first);
    if (any(is_first & walking)) {
      // The first ray looks further, for the other side of a thin object.
      const M near = is_first & (met <= load(block.reach + first));
      store(block.opposite + first, is_first, select(near, max(zero, -dot(d, n) * narrow(met)), zero));
    }
    const D3 p = load3(block.p, first) + travelled * widen(d);

    // Weight by all techniques that could have made the step: three channels, each by phase function or guided.
    const V3 clear = faded(of.sigma_t, t);
    const auto density = [&](const V3 &sigma, const V3 &transmittance) __attribute__((always_inline)) {
      return select(hits, transmittance, sigma * transmittance);
    };
    V3 pdf = density(of.sigma_t, clear);
    if (!all(is_first)) {
      const F stretch = load(block.stretch + first), share_back = load(block.backward_share + first);
      const V3 near = of.sigma_t * (one - stretch), far = of.sigma_t * (one + stretch);
      V3 guided = density(near, faded(near, t)) * load(block.forward + first);
      if (any(share_back > zero)) {
        const V3 other = density(far, faded(far, t)) * load(block.backward + first);
        guided = (one - share_back) * guided + share_back * other;
      }
      pdf = select(is_first, pdf, (one - of.guided) * pdf + of.guided * guided);
    }
    const F whole = dot(load3(block.channel, first), pdf);
    V3 beta = load3(block.beta, first) * select(hits, clear, of.sigma_s * clear) / whole;
    const M usable = (whole > zero) & (whole < F(__builtin_inff()));
    beta = select(usable, beta, V3(zero));
    store3(block.p, first, p);
    store3(block.beta, first, beta);
    const F brightest = largest_of_three(abs(beta));
    const M goes_on =
        walking & (!hits) & (brightest >= F(kFaintest)) & (to_float(steps) < F(static_cast<float>(kMostSteps - 1)));
    store(block.steps + first, steps + U(1u));
    going |= bits(goes_on) << first;
    left |= bits(walking & hits & (brightest > zero)) << first;
  }
  block.walking = going;
  block.left = left;
}

} // namespace

namespace LANCER_ISA {
const WalkKernel walk_kernel = {medium, step, advance};
}

} // namespace lancer
