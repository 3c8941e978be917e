// Local illumination of the recursive ray tracer, one light at one point without its shadow, and what surfaces mirror and let
// through. F is a float, or lanes of them.
#pragma once

#include "bsdf/bsdf.h"
#include "lancer.h"
#include "lights/light_lanes.h"
#include "sampling/color.h"
#include "sampling/elementary.h"

#include <limits>

namespace lancer {

// The lectures' attenuation; ratio = d / r.
template <class D> LANCER_LANE D attenuation(Falloff falloff, D ratio) {
  const D zero(0.0), one(1.0), rest = max(zero, one - ratio * ratio);
  switch (falloff) {
  case Falloff::Linear:
    return max(zero, one - ratio);
  case Falloff::Quadratic:
    return rest;
  case Falloff::Smooth:
    return rest * rest;
  case Falloff::Gaussian:
    return each(-(ratio * ratio), [](double x) { return exp(x); });
  case Falloff::Physical:
  case Falloff::Constant:
    break;
  }
  return one;
}

// What the texts call lc, as irradiance at normal incidence from a light's sample, after the light's own attenuation.
// The attenuations other than PHYSICAL replace 1/d^2: such a light is at every distance d att(d) times what it is at one unit.
template <class F> LANCER_LANE Vector3<F> classic_irradiance(const ClassicLight &light, const LightSampleLanes<F> &sample) {
  using D = DoubleOf<F>;
  const Double3Of<F> physical = widen(sample.radiance) / sample.pdf;
  if (light.falloff == Falloff::Physical)
    return narrow(physical);
  // Undo the inverse square in world units, then attenuate as the light asks.
  const D infinity(std::numeric_limits<double>::infinity()), d = sample.distance / D(light.world_unit);
  D ratio = infinity;
  if (light.radius > 0.0)
    ratio = sample.distance / D(light.radius);
  return narrow(select(sample.distance == infinity, physical, physical * (d * d * attenuation(light.falloff, ratio))));
}

// A power of a cosine that is 0 from behind; x^0 is 1 in front.
template <class F> LANCER_LANE F lobe_power(F cosine, F n) {
  return select(cosine > 0.0f, pow(min(cosine, F(1.0f)), n), F(0.0f));
}

inline constexpr uint32_t kClassicShapes = shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Beckmann) |
                                           shape_bit(LobeShape::Phong) | shape_bit(LobeShape::BlinnPhong);

// Sum of Kd/pi (l.n) lc and the specular lobes for one light; diffuse and specular colours of the light apply.
//   BECKMANN     Ks D F G / (4 (l.n)(v.n)) (l.n) lc
//   PHONG        Ks (R.V)^n lc / pi, BLINN_PHONG Ks (N.H)^n lc / pi: C of the lectures is lc / pi, so that Kd means the same
//   everywhere
// Lobes of other kinds give what they give in PATH, on the viewer's side. hidden: bits LANCER_RAY_* that the light is hidden
// from.
template <class F>
LANCER_LANE Vec3<F> classic_illumination(const Bsdf<F> &bsdf, const Vec3<F> &wi_world, const ClassicLight &light,
                                         const Vec3<F> &irradiance, uint32_t hidden) {
  using V = Vec3<F>;
  const F zero(0.0f);
  V diffuse(zero), specular(zero);
  uint8_t frame = 0;
  V wi = bsdf.frames[0].to_local(wi_world);
  uint32_t shapes = 0;
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe<F> &lobe = bsdf.lobes[i];
    const V &wo = bsdf.wo_local[lobe.frame];
    shapes |= shape_bit(lobe.shape);
    if (!(shape_bit(lobe.shape) & kClassicShapes))
      continue;
    if (lobe.frame != frame) {
      frame = lobe.frame;
      wi = bsdf.frames[frame].to_local(wi_world);
    }
    const MaskOf<F> above = (!black(lobe.color)) & (wi.z > zero);
    if (lobe.shape == LobeShape::Lambert) {
      diffuse = select(above, diffuse + lobe.color * (kInvPi * wi.z), diffuse);
      continue;
    }
    const MaskOf<F> seen = above & (wo.z > zero) & !lobe.delta;
    if (!any(seen))
      continue;
    F f;
    if (lobe.shape == LobeShape::Beckmann) {
      const V h = half_vector(wo, wi);
      f = coating_eval(lobe, wo, wi, h, coating_d(lobe, wo, h)) * wi.z;
    } else if (lobe.shape == LobeShape::Phong) {
      f = kInvPi * lobe_power(dot(reflect_local(wi), wo), lobe.shininess);
    } else {
      f = kInvPi * lobe_power(half_vector(wo, wi).z, lobe.shininess);
    }
    specular = select(seen, specular + lobe.color * f, specular);
  }
  if (shapes & ~kClassicShapes) {
    const BsdfValue<F> rest = bsdf.eval_lit(wi_world, kAllShapes & ~kClassicShapes);
    diffuse += rest.part[static_cast<int>(Component::Diffuse)];
    specular += rest.part[static_cast<int>(Component::Glossy)];
  }
  if (hidden & LANCER_RAY_DIFFUSE)
    diffuse = V(zero);
  if (hidden & LANCER_RAY_GLOSSY)
    specular = V(zero);
  return irradiance * (diffuse * V(light.diffuse_color) + specular * V(light.specular_color));
}

// What is mirrored and what is let through, as shares of light.
template <class F> struct BranchShares { Vec3<F> reflected{F(0.0f)}, refracted{F(0.0f)}; };

// Of a lobe, seen at that cosine to its normal.
template <class F> LANCER_LANE BranchShares<F> branch_shares(const Lobe<F> &lobe, F cosine) {
  BranchShares<F> shares;
  switch (lobe.shape) {
  case LobeShape::Mirror:
    shares.reflected = lobe.color;
    break;
  case LobeShape::Beckmann:
    shares.reflected = lobe.color * fresnel_dielectric(cosine, lobe.ior);
    break;
  case LobeShape::Ashikhmin:
    shares.reflected = lobe.albedo;
    break;
  case LobeShape::Dielectric:
    shares = {lobe.albedo - lobe.through, lobe.through};
    break;
  case LobeShape::Microfacet: {
    // What rough facets reflect on average; smooth ones, and those that let light through, answer as the one they are taken
    // for, so that no light is lost between the two shares.
    shares.reflected = lobe.albedo;
    const MaskOf<F> as_one = lobe.delta | uniform<F>(refracts(lobe));
    if (!any(as_one))
      break;
    const FacetResponse<F> response = facet_response(lobe, cosine);
    const Vec3<F> color = select(lobe.delta, lobe.color * lobe.energy, lobe.color);
    shares.reflected = select(as_one, color * response.reflected, shares.reflected);
    shares.refracted = select(as_one, color * response.through, shares.refracted);
    break;
  }
  default:
    break;
  }
  return shares;
}

// Weights of the mirrored and of the refracted ray, F c_s and (1 - F) c_s summed over the lobes, and where they go in the
// world: as the strongest lobe of each has it, about its own normal.
template <class F> struct Branches : BranchShares<F> { Vec3<F> mirrored{F(0.0f)}, through{F(0.0f)}; };

template <class F> LANCER_LANE Branches<F> find_branches(const Bsdf<F> &bsdf) {
  using V = Vec3<F>;
  const F zero(0.0f);
  Branches<F> branches;
  F most_reflected = zero, most_refracted = zero;
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe<F> &lobe = bsdf.lobes[i];
    const Frame<F> &frame = bsdf.frames[lobe.frame];
    const V &wo = bsdf.wo_local[lobe.frame];
    // From behind its own normal a lobe is not seen.
    const MaskOf<F> seen = (!black(lobe.color)) & (wo.z > zero);
    const BranchShares<F> shares = branch_shares(lobe, wo.z);
    branches.reflected = select(seen, branches.reflected + shares.reflected, branches.reflected);
    branches.refracted = select(seen, branches.refracted + shares.refracted, branches.refracted);
    const F reflected = mean(shares.reflected), refracted = mean(shares.refracted);
    const MaskOf<F> mirrors = seen & (reflected > most_reflected), passes = seen & (refracted > most_refracted);
    most_reflected = select(mirrors, reflected, most_reflected);
    most_refracted = select(passes, refracted, most_refracted);
    if (any(mirrors))
      branches.mirrored = select(mirrors, frame.to_world(reflect_local(wo)), branches.mirrored);
    if (any(passes)) {
      // Straight on where the index bends nothing.
      const Fresnel<F> boundary = fresnel(wo.z, lobe.ior);
      const MaskOf<F> bends = (lobe.ior != F(1.0f)) & (boundary.cos_t > zero);
      const V bent = select(bends, frame.to_world(refract_local(wo, lobe.ior, boundary.cos_t)), -bsdf.wo);
      branches.through = select(passes, bent, branches.through);
    }
  }
  return branches;
}

} // namespace lancer
