// Sun lights: a single direction, or a disk of the sky, either uniform in solid angle or a flat disk.
#pragma once

#include "lights/round_light.h"

#include <limits>

namespace lancer {

// Radiance and density of the sun's disk in a direction whose cosine to the disk's middle is given. emission: the irradiance at
// normal incidence.
template <class F> struct SunDisk {
  Vector3<F> radiance;
  DoubleOf<F> pdf;
};

// size: Light::one_minus_cos_sun; radius: Light::flat_radius.
template <class F>
LANCER_LANE SunDisk<F> sun_disk(const Double3Of<F> &emission, DoubleOf<F> size, DoubleOf<F> radius, DoubleOf<F> cosine,
                                MaskOf<F> flat) {
  using D = DoubleOf<F>;
  const D one(1.0), two(2.0), pi(std::numbers::pi);
  // E = pi L sin^2(half angle).
  SunDisk<F> disk{narrow(emission / (pi * (size * (two - size)))), one / (D(2.0 * std::numbers::pi) * size)};
  if (any(flat)) {
    // At distance 1, each part of the flat disk emits in proportion to its area: the density per solid angle has the factor 1 /
    // cos^3. The mean cosine of the disk is 2 / (sqrt(1 + r^2) + 1).
    const D r2 = radius * radius, pdf = one / (pi * r2 * cosine * cosine * cosine);
    disk.radiance = select(flat, narrow(emission * (D(0.5) * (sqrt(one + r2) + one) * pdf)), disk.radiance);
    disk.pdf = select(flat, pdf, disk.pdf);
  }
  return disk;
}

// disk: warp_disk() of the sample's random numbers.
template <template <class> class L, class F>
LANCER_LANE void sample_sun(const L<F> &light, const Vector2<F> &disk, MaskOf<F> which, LightSampleLanes<F> &sample) {
  using D = DoubleOf<F>;
  using M = MaskOf<F>;
  const D zero(0.0), size = light[&Light::one_minus_cos_sun], radius = light[&Light::flat_radius];
  const Double3Of<F> x = light[&Light::x], y = light[&Light::y], z = light[&Light::z], emission = light[&Light::emission];
  const M single = which & (size == zero), wide = which & !single, flat = wide & (radius != zero);
  const Vector2<D> place{widen(disk.x), widen(disk.y)};
  Double3Of<F> wi = z;
  if (any(wide & !flat))
    wi = select(wide & !flat, cone_direction(z, {x, y}, size, place), wi);
  if (any(flat))
    wi = select(flat, normalize(z + radius * place.x * x + radius * place.y * y), wi);
  Vector3<F> radiance = narrow(emission);
  D pdf(1.0);
  if (any(wide)) {
    const SunDisk<F> seen = sun_disk<F>(emission, size, radius, dot(wi, z), flat);
    radiance = select(wide, seen.radiance, radiance);
    pdf = select(wide, seen.pdf, pdf);
  }
  sample.wi = select(which, wi, sample.wi);
  sample.distance = select(which, D(std::numeric_limits<double>::infinity()), sample.distance);
  sample.radiance = select(which, radiance, sample.radiance);
  sample.pdf = select(which, pdf, sample.pdf);
  sample.delta = sample.delta | single;
}

// |wi - z|^2 = 2 (1 - cos): no cancellation, however small the sun.
template <template <class> class L, class F>
LANCER_LANE DoubleOf<F> one_minus_cos_to(const L<F> &light, const Double3Of<F> &wi) {
  const Double3Of<F> apart = wi - light[&Light::z];
  return DoubleOf<F>(0.5) * dot(apart, apart);
}
template <class D> LANCER_LANE auto is_on_sun(D size, D one_minus_cos) { return (size != D(0.0)) & (one_minus_cos <= size); }

template <template <class> class L, class F> LANCER_LANE LightHitLanes<F> meet_sun(const L<F> &light, const Double3Of<F> &wi) {
  using D = DoubleOf<F>;
  const D one_minus_cos = one_minus_cos_to(light, wi), size = light[&Light::one_minus_cos_sun];
  const D radius = light[&Light::flat_radius];
  const SunDisk<F> disk = sun_disk<F>(light[&Light::emission], size, radius, D(1.0) - one_minus_cos, radius != D(0.0));
  return {disk.radiance, select(is_on_sun(size, one_minus_cos), disk.pdf, D(0.0)), D(std::numeric_limits<double>::infinity())};
}

} // namespace lancer
