// Compiled once per instruction set, with LANCER_ISA as its name. This file must emit no shared (weak) symbol: see
// bvh_kernel.cpp.
#include "integrator/stages/light.h"
#include "scene/enums.h"

#include "integrator/stages/lobe_lanes.h"
#include "integrator/stages/terminator.h"
#include "lights/sample_light.h"
#include "lights/seen_face.h"
#include "scene/hit_surface.h"

namespace lancer {
namespace {

[[gnu::flatten]] void choose(const SurfaceBlock &surfaces, const LobeBlock &lobes, const VertexNumbers &numbers,
                             const LightNodes &tree, LightChoices &choices) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(lobes.used >> first))
      return;
    const LightQueryLanes<F> query(load3(surfaces.p, first), load3(lobes.ns, first), some(lobes.transmits, first));
    const D u =
        widen(load(numbers.of[kVertexLightChoice] + first)) + D(0x1p-24) * widen(load(numbers.of[kVertexLightDigits] + first));
    const LightChoiceLanes<F> choice = choose_light(query, tree, u, mask_of((1u << kLanes) - 1u));
    store(choices.number + first, choice.number);
    store(choices.probability + first, choice.probability);
    store(choices.rest + first, choice.u);
  }
}

// Samples lights in the given lanes; the other lanes keep their samples.
template <class Lights>
LANCER_LANE void sample_lanes(const Lights &lights, int first, M lanes, const Doubles (&p)[3], const VertexNumbers &numbers,
                              D probability, LightSamples &samples) {
  LightSampleLanes<F> sample;
  sample.target = load3(samples.target, first);
  sample.wi = load3(samples.wi, first);
  sample.distance = load(samples.distance + first);
  sample.radiance = load3(samples.radiance, first);
  sample.delta = !equal(load(samples.delta + first), U(0u));
  sample.pdf = load(samples.pdf + first);
  sample_light(lights, load3(p, first), load(numbers.of[kVertexLight] + first), load(numbers.of[kVertexLight + 1] + first),
               lanes, sample);
  store3(samples.target, first, sample.target);
  store3(samples.wi, first, sample.wi);
  store(samples.distance + first, sample.distance);
  store3(samples.radiance, first, sample.radiance);
  store(samples.delta + first, select(sample.delta, U(1u), U(0u)));
  store(samples.pdf + first, select(lanes, sample.pdf * probability, sample.pdf));
}

void sample_lamps(const Light *const *lamps, const Doubles (&p)[3], const VertexNumbers &numbers, const Doubles &probability,
                  uint32_t lanes, LightSamples &samples) {
  for (int first = 0; first < kBlockLanes; first += kLanes)
    if (const M here = some(lanes, first); any(here))
      sample_lanes(EachLight<F>{lamps + first}, first, here, p, numbers, load(probability + first), samples);
}

void sample_lamp(const Light &lamp, const Doubles (&p)[3], const VertexNumbers &numbers, uint32_t lanes,
                 LightSamples &samples) {
  for (int first = 0; first < kBlockLanes; first += kLanes)
    if (const M here = some(lanes, first); any(here))
      sample_lanes(OneLight<F>{lamp}, first, here, p, numbers, D(1.0), samples);
}

[[gnu::flatten]] void sample_sky(const DirectionTable &map, SkyBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const DirectionSample<F> sample = sample_direction(map, load(block.u[0] + first), load(block.u[1] + first));
    store3(block.wi, first, sample.direction);
    store(block.pdf + first, sample.pdf);
  }
}

[[gnu::flatten]] void sky_density(const DirectionTable &map, SkyBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes)
    store(block.pdf + first, direction_pdf(map, narrow(load3(block.wi, first))));
}

[[gnu::flatten]] void sample_sky_through(const DirectionTable &map, const Openings &openings, SkyBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    const DirectionSample<F> sample =
        sample_through<F>(map, openings, load3(block.p, first), load(block.u[0] + first), load(block.u[1] + first));
    store3(block.wi, first, sample.direction);
    store(block.pdf + first, sample.pdf);
  }
}

[[gnu::flatten]] void sky_density_through(const DirectionTable &map, const Openings &openings, SkyBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes)
    store(block.pdf + first, density_through<F>(map, openings, load3(block.p, first), load3(block.wi, first)));
}

[[gnu::flatten]] void sample_faces(FaceBlock &block) {
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(block.used >> first))
      return;
    const Placements<F> placed(block.placement + first);
    V3 corner[3];
    for (int i = 0; i < 3; ++i)
      corner[i] = load3(block.corner[i], first);
    const D3 p = load3(block.p, first);
    const SeenFace<F> seen(MapLanes<F>(placed, Placements<F>::kToWorld), corner, p);
    const Vector2<D> weights = seen.sample(load(block.u[0] + first), load(block.u[1] + first));
    const SurfaceLanes<F> surface = triangle_surface(placed, corner, corner, mask_of(0), weights.x, weights.y);
    const D3 v = surface.p - p, ng = widen(surface.ng);
    const D distance = sqrt(dot(v, v));
    const D3 wi = v / distance;
    // End on the side that p sees, off the surface by the surface's own error bound.
    const D side = select(dot(ng, wi) < D(0.0), D(1.0), D(-1.0));
    store3(block.wi, first, wi);
    store3(block.target, first, D3(surface.p + (side * surface.offset) * ng));
    store(block.distance + first, distance);
    store(block.pdf + first, select(distance > D(0.0), seen.pdf(v, surface.ng), D(0.0)));
    store(block.weights[0] + first, weights.x);
    store(block.weights[1] + first, weights.y);
    store3(block.ng, first, surface.ng);
  }
}

LANCER_LANE M has_bit(const uint32_t *words, uint32_t bit) { return !equal(load(words) & U(bit), U(0u)); }

// Returns a / b, and 0 where b is 0.
LANCER_LANE V3 divided(const V3 &a, const V3 &b) {
  const F zero(0.0f);
  return {select(b.x != zero, a.x / b.x, zero), select(b.y != zero, a.y / b.y, zero), select(b.z != zero, a.z / b.z, zero)};
}

// Computes the contribution of the lanes that have a light sample.
LANCER_LANE void light_of(const LitVertices &vertices, const LightSamples &samples, int first, LitBlock &block) {
  const F zero(0.0f);
  const LobeBlock &lobes = vertices.lobes;
  const D pdf = load(samples.pdf + first);
  const V3 radiance = load3(samples.radiance, first);
  const M lit = (pdf > D(0.0)) & (!black(radiance)) & some(lobes.scatters, first);
  if (!any(lit))
    return;
  const Bsdf<F> &bsdf = lobes_of(lobes, first);
  const V3 wi = narrow(load3(samples.wi, first));
  // In the order of Component.
  const M hidden[3] = {has_bit(samples.hidden + first, RayKind::Diffuse), has_bit(samples.hidden + first, RayKind::Glossy),
                       has_bit(samples.hidden + first, RayKind::Transmission)};
  const bool hides = any(hidden[0] | hidden[1] | hidden[2]);
  const BsdfValue<F> value = bsdf.eval_lit(wi, kAllShapes, hides ? hidden : nullptr);
  const V3 f = value.f();
  // BSDF samples find the same light, unless it is a single direction; only paths that are scattered take them. The weights
  // count one sample of each technique even where samples split, as in Cycles. The count matters: with interpolated normals,
  // the two techniques do not find the same light, so that the weights change the picture.
  const D scatters = D(1.0) - widen(load(lobes.pass + first)), weighed = load(samples.weighed + first);
  const F weight = select(has_bit(samples.delta + first, 1u), F(1.0f),
                          mis_weight(select(weighed > D(0.0), weighed, pdf), widen(value.pdf) * scatters));
  // f over a density is of the order of 1, however narrow the lobe and however bright the light.
  const V3 contribution =
      load3(vertices.beta, first) * (f * narrow(widen(weight) / (pdf * load(vertices.count + first)))) * radiance;
  store3(block.contribution, first, contribution);
  for (int component = 0; component < 2 && lobes.shares; ++component)
    store3(block.share[component], first, divided(value.part[component], f));
  block.lit |= placed_bits(lit & !black(f), first);
  block.lifted |=
      placed_bits(terminator_amount(load(vertices.surfaces.terminator + first), bsdf.ns, bsdf.ng, wi) > zero, first);
}

void light(const LitVertices &vertices, const LightSamples &samples, LitBlock &lit) {
  lit.lit = lit.lifted = 0;
  const SurfaceBlock &surfaces = vertices.surfaces;
  for (int first = 0; first < kBlockLanes; first += kLanes) {
    if (!(vertices.lobes.used >> first))
      return;
    light_of(vertices, samples, first, lit);
    store3(lit.origin, first,
           origin_towards(load3(surfaces.p, first), load(surfaces.offset + first), widen(load3(surfaces.ng, first)),
                          load3(samples.wi, first)));
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
                           MetBlock &met) {
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
const LightKernel light_kernel = {choose,      sample_lamps,       sample_lamp,         sample_faces, sample_sky,
                                  sky_density, sample_sky_through, sky_density_through, light,        meets,
                                  meet};
}

} // namespace lancer
