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

enum Number : uint32_t { kDistance, kStrategy, kSide, kCosine, kTurn };

// Random numbers of the lanes' current steps.
struct Numbers {
  U key;
  LANCER_LANE F operator()(Number number) const {
    return to_float(hash_combine(key, U(static_cast<uint32_t>(number))) >> 8) * F(0x1p-24f);
  }
};

// The medium of a lane's current step.
struct Step {
  V3 sigma_t, sigma_s;
  F g, guided; // guided: probability of a direction towards the surface
};
LANCER_LANE Step step_of(const WalkBlock &block, int first) {
  const F given = load(block.g + first);
  const V3 sigma_t = load3(block.sigma_t, first), sigma_s = load3(block.sigma_s, first), ahead = sigma_s * given;
  const M even = to_float(load(block.steps + first)) > F(static_cast<float>(kDirectedSteps));
  return {select(even, sigma_t - ahead, sigma_t), select(even, sigma_s - ahead, sigma_s), select(even, F(0.0f), given),
          select(even, F(kGuidedEven), load(block.guided + first))};
}

LANCER_LANE F smallest(const V3 &v) { return min(min(v.x, v.y), v.z); }
LANCER_LANE F largest_of_three(const V3 &v) { return max(max(v.x, v.y), v.z); }
LANCER_LANE V3 faded(const V3 &sigma, F t) { return {exp(-sigma.x * t), exp(-sigma.y * t), exp(-sigma.z * t)}; }
LANCER_LANE F channel_of(const V3 &v, U hero) { return select(equal(hero, U(0u)), v.x, select(equal(hero, U(1u)), v.y, v.z)); }

void begin(WalkBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const M now = some(block.walking, first);
    if (!any(now))
      continue;
    const F zero(0.0f), one(1.0f);
    const V3 before = load3(block.beta, first);
    V3 beta = before, sigma_t(one), albedo(F(0.5f));
    const Vec3<F> color = load3(block.color, first), given = load3(block.radius, first);
    const F g = load(block.g + first);
    const U method = load(block.method + first);
    for (const auto which : {SubsurfaceMethod::RandomWalkLegacy, SubsurfaceMethod::Skin, SubsurfaceMethod::RandomWalk}) {
      const M mine = now & equal(method, U(static_cast<uint32_t>(which)));
      if (!any(mine))
        continue;
      Vec3<F> weight = before;
      const Vec3<F> radius = walking_radius<F>(which, given, color, load(block.ior + first));
      const Medium<F> found = medium_below<F>(which, color, radius, g, weight);
      sigma_t = select(mine, V3(found.sigma_t), sigma_t);
      albedo = select(mine, V3(found.albedo), albedo);
      beta = select(mine, V3(weight), beta);
    }
    // Choose the channel to walk for by the light that is expected to come back.
    const F sum = abs(before.x) + abs(before.y) + abs(before.z);
    const V3 chance = select(sum > zero, abs(before) / sum, V3(F(1.0f / 3.0f)));
    const F u = load(block.u_channel + first);
    const M red = u < chance.x, green = (!red) & ((u < chance.x + chance.y) | (chance.z == zero));
    const F v = diffusion_length(largest_of_three(albedo));
    store3(block.sigma_t, first, sigma_t);
    store3(block.sigma_s, first, sigma_t * albedo);
    // A medium without depth absorbs all.
    store3(block.light, first, select(v > one, beta, V3(zero)));
    store3(block.densities, first, chance);
    store(block.hero + first, select(red, U(0u), select(green, U(1u), U(2u))));
    store(block.guided + first, select(g == zero, F(0.5f), one - max(F(0.5f), pow(abs(g), F(0.125f)))));
    store(block.length + first, v);
    store(block.log_length + first, log((v + one) / max(v - one, F(0x1p-100f))));
    store(block.depth + first, zero);
    store(block.opposite + first, zero);
    store(block.steps + first, U(0u));
  }
}

void step(WalkBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!any(some(block.walking, first)))
      continue;
    const F zero(0.0f), one(1.0f);
    const U steps = load(block.steps + first);
    const Numbers random{hash_combine(load(block.key + first), steps)};
    const Step of = step_of(block, first);
    const M is_first = equal(steps, U(0u));
    F sigma = channel_of(of.sigma_t, load(block.hero + first));

    // Sample the direction: that of entry, by the phase function, or towards the surface, the near one or the opposite.
    const V3 n = load3(block.n, first);
    V3 d = load3(block.d, first);
    F forward = zero, backward = zero, stretch = zero, share_back = zero;
    if (!all(is_first)) {
      const F v = load(block.length + first), log_v = load(block.log_length + first), opposite = load(block.opposite + first);
      const M has_opposite = opposite > zero, guided = random(kStrategy) < of.guided;
      M back = uniform<F>(false);
      if (any(has_opposite)) {
        const F depth = min(max(load(block.depth + first), zero), opposite);
        share_back = select(has_opposite, one / (one + exp((opposite - F(2.0f) * depth) / v)), zero);
        back = guided & (random(kSide) < share_back);
      }
      const F u = random(kCosine), by_guide = dwivedi_sample(v, log_v, u);
      const F cosine_axis = select(guided, select(back, -by_guide, by_guide), henyey_greenstein_sample(of.g, u));
      const V3 next = around<F>(select(guided, n, d), cosine_axis, random(kTurn));
      const F cosine = select(guided, cosine_axis, dot(next, n));
      // Ratios of the guided densities to that of the phase function; the distance is stretched or shortened alike.
      const F phase = henyey_greenstein(dot(d, next), of.g), scale = F(0.5f * kInvPi) / (log_v * phase);
      forward = scale / (v - cosine);
      backward = scale / (v + cosine);
      stretch = cosine / v;
      sigma = select(is_first, sigma, sigma * select(guided, select(back, one + stretch, one - stretch), one));
      d = select(is_first, d, next);
    }
    const F u = select(is_first, load(block.u_distance + first), random(kDistance));
    const F t = -log(one - u) / sigma;
    store3(block.d, first, d);
    store(block.forward + first, forward);
    store(block.backward + first, backward);
    store(block.stretch + first, stretch);
    store(block.backward_share + first, share_back);
    store(block.t + first, t);
    store(block.reach + first, select(is_first, max(t, F(kNearOpposite) / smallest(of.sigma_t)), t));
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
    const U steps = load(block.steps + first), hero = load(block.hero + first);
    const M is_first = equal(steps, U(0u));
    const D wanted = widen(load(block.t + first)), met = load(block.met + first);
    const M hits = met < wanted;
    const D travelled = select(hits, met, wanted);
    const F t = narrow(travelled);
    const V3 d = load3(block.d, first);
    const F down = -dot(load3(block.n, first), d);
    if (any(is_first & walking)) {
      // The first ray looks further, for the other side of a thin object.
      const M near = is_first & (met < D(__builtin_inf()));
      store(block.opposite + first, is_first, select(near, max(zero, down * narrow(met)), zero));
    }
    store3(block.p, first, load3(block.p, first) + travelled * widen(d));
    store(block.depth + first, load(block.depth + first) + down * t);

    // Weigh by all techniques that could have made the step: three channels, each by phase function or guided.
    const V3 clear = faded(of.sigma_t, t);
    const auto density = [&](const V3 &sigma, const V3 &transmittance) __attribute__((always_inline)) {
      return select(hits, transmittance, sigma * transmittance);
    };
    V3 pdf = density(of.sigma_t, clear);
    if (!all(is_first)) {
      const F stretch = load(block.stretch + first), share_back = load(block.backward_share + first);
      const V3 near = of.sigma_t * (one - stretch);
      V3 guided = density(near, faded(near, t)) * load(block.forward + first);
      if (any(share_back > zero)) {
        const V3 far = of.sigma_t * (one + stretch);
        guided = (one - share_back) * guided + share_back * load(block.backward + first) * density(far, faded(far, t));
      }
      pdf = select(is_first, pdf, (one - of.guided) * pdf + of.guided * guided);
    }
    const F own = channel_of(pdf, hero);
    const M usable = (own > zero) & (own < F(__builtin_inff()));
    const F scale = select(usable, one / own, zero);
    const V3 light = load3(block.light, first) * select(hits, clear, of.sigma_s * clear) * scale;
    const V3 densities = load3(block.densities, first) * pdf * scale;
    const F sum = densities.x + densities.y + densities.z;
    const M counts = usable & (sum > zero) & (sum < F(__builtin_inff()));
    const V3 throughput = select(counts, light / sum, V3(zero));
    store3(block.light, first, light);
    store3(block.densities, first, densities);
    store3(block.throughput, first, throughput);
    const F brightest = largest_of_three(abs(throughput));
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
const WalkKernel walk_kernel = {begin, step, advance};
}

} // namespace lancer
