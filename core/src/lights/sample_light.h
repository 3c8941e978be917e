// sample() and meet() of lights for lanes. F is a float, or lanes of floats.
#pragma once

#include "lights/area_light.h"
#include "lights/sun_light.h"

namespace lancer {

// Returns the MIS weight of a sample with density pdf that another technique finds with density other: the power heuristic, in
// the form of a ratio, so that infinite densities give 0 or 1 and never NaN.
template <class D> LANCER_LANE auto mis_weight(D pdf, D other) {
  const D ratio = other / pdf;
  return narrow(D(1.0) / (D(1.0) + ratio * ratio));
}

template <class U> LANCER_LANE auto is_kind(U kind, LightKind which) { return equal(kind, U(static_cast<uint32_t>(which))); }

// Samples the lights of the requested lanes, seen from p in the normalised world; the other lanes stay as they are. pdf per
// solid angle, 0: no sample; the radiance of a sample may be black. See LightSample.
template <template <class> class L, class F>
LANCER_LANE void sample_light(const L<F> &light, const Double3Of<F> &p, F u, F v, MaskOf<F> asked,
                              LightSampleLanes<F> &sample) {
  using M = MaskOf<F>;
  const auto kind = light.kind();
  const M area = asked & is_kind(kind, LightKind::Area), spot = asked & is_kind(kind, LightKind::Spot);
  const M round = spot | (asked & is_kind(kind, LightKind::Point)), sun = asked & is_kind(kind, LightKind::Sun);
  const Vector2<F> disk = warp_disk(u, v);
  sample.pdf = select(asked, DoubleOf<F>(0.0), sample.pdf);
  sample.delta = sample.delta & !asked;
  if (any(area))
    sample_area(AreaNumbers<F>(light, area), p, u, v, disk, area, sample);
  if (any(round))
    sample_round(light, p, u, v, disk, round, spot, sample);
  if (any(sun))
    sample_sun(light, disk, sun, sample);
}

// The light hit by rays from o along unit wi. A light without extent is never hit.
template <class F>
LANCER_LANE LightHitLanes<F> meet_light(const OneLight<F> &light, const Double3Of<F> &o, const Double3Of<F> &wi) {
  switch (light.light.kind) {
  case LightKind::Sun:
    return meet_sun(light, wi);
  case LightKind::Area:
    return meet_area(AreaNumbers<F>(light, is_kind(light.kind(), LightKind::Area)), o, wi);
  default:
    return meet_round(light, o, wi, is_kind(light.kind(), LightKind::Spot));
  }
}

// Returns the lanes whose ray hits the light, before end or, for disks and rectangles, not much beyond it; suns have no
// distance.
template <class F>
LANCER_LANE MaskOf<F> may_meet(const OneLight<F> &light, const Double3Of<F> &o, const Double3Of<F> &wi, DoubleOf<F> end) {
  switch (light.light.kind) {
  case LightKind::Sun:
    return is_on_sun(light[&Light::one_minus_cos_sun], one_minus_cos_to(light, wi));
  case LightKind::Area: {
    const AreaMeeting<F> at = find_area(AreaNumbers<F>(light, is_kind(light.kind(), LightKind::Area)), o, wi);
    return at.met & (at.t < end);
  }
  default: {
    const RoundMeeting<F> at = find_round(light, o, wi);
    return at.met & (at.t < end);
  }
  }
}

// One light and one point, at width 1.
inline LightSample sample(const Light &light, const glm::dvec3 &p, const glm::vec2 &u) {
  LightSampleLanes<float> found{};
  sample_light(OneLight<float>{light}, Vector3<double>(p), u.x, u.y, true, found);
  return {found.target, found.wi, found.distance, found.radiance, found.pdf, found.delta};
}

// Returns pdf 0 where the ray misses; a light without extent is never hit.
inline LightHit meet(const Light &light, const glm::dvec3 &o, const glm::dvec3 &wi) {
  const LightHitLanes<float> hit = meet_light(OneLight<float>{light}, Vector3<double>(o), Vector3<double>(wi));
  return hit.pdf > 0.0 ? LightHit{hit.radiance, hit.pdf, hit.distance} : LightHit{};
}

} // namespace lancer
