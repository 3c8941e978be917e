// Local illumination of the recursive ray tracer: one light at one point without occlusion; and the mirrored and transmitted
// shares of surfaces. F is a float, or lanes of floats.
#pragma once

#include "bsdf/bsdf.h"
#include "lights/light.h"
#include "sampling/elementary.h"
#include "scene/enums.h"
#include "simd/vectors.h"

#include <limits>

namespace lancer {

// Returns the lectures' attenuation; ratio = d / r.
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

// Returns lc of the texts: the irradiance at normal incidence from a light's sample, after the light's own attenuation.
// Attenuations other than PHYSICAL replace 1/d^2: at distance d, the light has att(d) times its irradiance at one unit.
template <class F> LANCER_LANE Vector3<F> classic_irradiance(const ClassicLight &light, const LightSampleLanes<F> &sample) {
  using D = DoubleOf<F>;
  const Double3Of<F> physical = widen(sample.radiance) / sample.pdf;
  if (light.falloff == Falloff::Physical)
    return narrow(physical);
  // Multiply by the squared distance in the user's units, then apply the light's attenuation.
  const D infinity(std::numeric_limits<double>::infinity()), d = sample.distance / D(light.world_unit);
  D ratio = infinity;
  if (light.radius > 0.0)
    ratio = sample.distance / D(light.radius);
  return narrow(select(sample.distance == infinity, physical, physical * (d * d * attenuation(light.falloff, ratio))));
}

// Returns a power of a cosine: 0 from behind; x^0 is 1 in front.
template <class F> LANCER_LANE F lobe_power(F cosine, F n) {
  return select(cosine > 0.0f, pow(min(cosine, F(1.0f)), n), F(0.0f));
}

inline constexpr uint32_t kClassicShapes = shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Beckmann) |
                                           shape_bit(LobeShape::Phong) | shape_bit(LobeShape::BlinnPhong);

// Returns the sum of Kd/pi (l.n) lc and the specular lobes for one light, with the light's diffuse and specular colours.
//   BECKMANN     Ks D F G / (4 (l.n)(v.n)) (l.n) lc
//   PHONG        Ks (R.V)^n lc / pi
//   BLINN_PHONG  Ks (N.H)^n lc / pi
// C of the lectures is lc / pi, so that Kd means the same in all models. Lobes of other kinds give the same as in PATH, on the
// viewer's side. hidden: RayKind bits of the rays that do not see the light.
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
  if (hidden & RayKind::Diffuse)
    diffuse = V(zero);
  if (hidden & RayKind::Glossy)
    specular = V(zero);
  return irradiance * (diffuse * V(light.diffuse_color) + specular * V(light.specular_color));
}

// The mirrored and the transmitted share of light.
template <class F> struct BranchShares { Vec3<F> reflected{F(0.0f)}, refracted{F(0.0f)}; };

// Returns the shares of a lobe. cosine: between the view direction and the lobe's normal.
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
    if (passes_through(lobe)) {
      shares.refracted = lobe.albedo;
      break;
    }
    // Rough facets use their mean reflection. Smooth facets and facets that refract are treated as a single smooth boundary, so
    // that no light is lost between the two shares.
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

// Weights of the mirrored and of the refracted ray, F c_s and (1 - F) c_s summed over the lobes, and their directions in the
// world: those of the strongest lobe of each kind, about the lobe's own normal.
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
    // A lobe is invisible from behind its own normal.
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
      // The ray passes straight through where the index does not refract.
      const Fresnel<F> boundary = fresnel(wo.z, lobe.ior);
      const MaskOf<F> bends = (lobe.ior != F(1.0f)) & (boundary.cos_t > zero);
      const V bent = select(bends, frame.to_world(refract_local(wo, lobe.ior, boundary.cos_t)), -bsdf.wo);
      branches.through = select(passes, bent, branches.through);
    }
  }
  return branches;
}

} // namespace lancer
