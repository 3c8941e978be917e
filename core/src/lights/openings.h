// Openings through which the environment lights a scene, as windows of a room: directions through them are a technique of
// sampling the environment beside its map. Both together have one density. F is a float, or lanes of floats.
#pragma once

#include "lights/area_light.h"
#include "sampling/direction_map.h"

#include <limits>

namespace lancer {

// Share of the samples that go through the openings before which a point lies; the map takes the rest, and all where there is
// none, as in Cycles.
inline constexpr double kOpeningShare = 0.5;

// The openings of a scene: area lights with the whole hemisphere as their spread, whose emission is not read.
struct Openings {
  const Light *areas = nullptr;
  uint32_t count = 0;

  bool any() const { return count > 0; }
};

// Whether points are on the side into which an opening lets light.
template <class F> LANCER_LANE MaskOf<F> is_before(const OneLight<F> &opening, const Double3Of<F> &p) {
  return dot(opening[&Light::position] - p, opening[&Light::z]) > DoubleOf<F>(0.0);
}

// Returns the number of openings that points are before.
template <class F> LANCER_LANE DoubleOf<F> count_before(const Openings &openings, const Double3Of<F> &p) {
  using D = DoubleOf<F>;
  D count(0.0);
  for (uint32_t i = 0; i < openings.count; ++i)
    count = select(is_before(OneLight<F>{openings.areas[i]}, p), count + D(1.0), count);
  return count;
}

// Returns the density per solid angle with which sample_through() finds unit directions from p; map: of the environment.
template <class F>
LANCER_LANE DoubleOf<F> density_through(const DirectionTable &map, const Openings &openings, const Double3Of<F> &p,
                                        const Double3Of<F> &wi) {
  using D = DoubleOf<F>;
  const D zero(0.0), of_map = direction_pdf(map, narrow(wi)), before = count_before<F>(openings, p);
  D through = zero;
  for (uint32_t i = 0; i < openings.count; ++i) {
    const OneLight<F> opening{openings.areas[i]};
    const AreaNumbers<F> area(opening, is_before(opening, p));
    const AreaMeeting<F> at = find_area(area, p, wi);
    if (any(at.met))
      through = select(at.met, through + see_area(area, at.part, p).pdf(at.t, at.cosine, at.part.area), through);
  }
  return select(before > zero, D(1.0 - kOpeningShare) * of_map + D(kOpeningShare) * (through / before), of_map);
}

// Samples directions of the environment seen from p: each opening that p is before gets an equal part of kOpeningShare.
template <class F>
LANCER_LANE DirectionSample<F> sample_through(const DirectionTable &map, const Openings &openings, const Double3Of<F> &p, F u,
                                              F v) {
  using D = DoubleOf<F>;
  using M = MaskOf<F>;
  using U = WordOf<F>;
  const D share(kOpeningShare), zero(0.0), number = widen(u), before = count_before<F>(openings, p);
  const M some = before > zero, through = some & (number < share);
  // The first numbers choose an opening and a place on it, the others a direction of the map.
  const F below_one(1.0f - 0.5f * std::numeric_limits<float>::epsilon());
  const D place = select(through, number / share * before, zero);
  const U chosen = truncate(place);
  const F along = min(narrow(place - widen(to_float(chosen))), below_one);
  const D rest = select(some, (number - share) / D(1.0 - kOpeningShare), number);
  DirectionSample<F> sample = sample_direction(map, min(narrow(max(rest, zero)), below_one), v);
  LightSampleLanes<F> found{};
  U rank(0u);
  for (uint32_t i = 0; i < openings.count; ++i) {
    const OneLight<F> opening{openings.areas[i]};
    const M here = is_before(opening, p), take = through & here & equal(rank, chosen);
    rank = select(here, rank + U(1u), rank);
    if (!any(take))
      continue;
    found.pdf = select(take, zero, found.pdf);
    sample_area(AreaNumbers<F>(opening, take), p, along, v, warp_disk(along, v), take, found);
  }
  sample.direction = select(through, found.wi, sample.direction);
  const D pdf = density_through<F>(map, openings, p, sample.direction);
  sample.pdf = select(select(through, found.pdf, sample.pdf) > zero, pdf, zero);
  return sample;
}

} // namespace lancer
