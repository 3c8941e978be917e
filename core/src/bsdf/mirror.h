// Lobes of single directions: a mirror, the coating that is too smooth to be sampled as rough, and smooth glass.
#pragma once

#include "bsdf/frame.h"
#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"

namespace lancer {

// A direction of a delta lobe: weight without the lobe's colour, and the probability of having taken it.
template <class F> struct DeltaDirection {
  Vec3<F> wi{F(0.0f)};
  F weight{0.0f};
  F probability{0.0f};
};

template <class V> LANCER_LANE DeltaDirection<NumberOf<V>> mirror_sample(const V &wo) {
  using F = NumberOf<V>;
  return {reflect_local(wo), F(1.0f), F(1.0f)};
}

// The mirror with Fresnel's weight.
template <class F> LANCER_LANE DeltaDirection<F> smooth_coating_sample(const Lobe<F> &lobe, const Vec3<F> &wo) {
  return {reflect_local(wo), fresnel_dielectric(wo.z, lobe.ior), F(1.0f)};
}

// Smooth glass, reflected with probability F, else refracted. wo.z > 0; the lobe's index is that of the far side over that of
// the near one. u in [0, 1).
// The radiance is not scaled with 1/eta^2 on the way through: a path that leaves the glass again would undo it, and Cycles,
// with which pictures agree, does without it for lights and cameras inside glass, too.
template <class F> LANCER_LANE DeltaDirection<F> dielectric_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u) {
  const F eta = lobe.ior;
  const auto straight = eta == F(1.0f);
  const Fresnel<F> boundary = fresnel(wo.z, eta);
  // Both choices carry their share as probability, so that the weight stays 1.
  const auto reflects = (u < boundary.reflectance) & !straight;
  const Vec3<F> through = select(straight, -wo, refract_local(wo, eta, boundary.cos_t));
  return {select(reflects, reflect_local(wo), through), F(1.0f),
          select(reflects, boundary.reflectance, select(straight, F(1.0f), 1.0f - boundary.reflectance))};
}

} // namespace lancer
