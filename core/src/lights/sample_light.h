// sample() and meet() of lights for lanes: F is a float, or lanes of them.
#pragma once

#include "lights/area_light.h"
#include "lights/sun_light.h"

namespace lancer {

template <class U> LANCER_LANE auto is_kind(U kind, LightKind which) { return equal(kind, U(static_cast<uint32_t>(which))); }

// Of the lanes that are asked for; the others stay. Light may be black there.
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

// A light on ways from o along unit wi. One without extent is never met.
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

// Lanes whose way meets the light, before end or, of disks and rectangles, not much further; suns have no distance.
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

} // namespace lancer
