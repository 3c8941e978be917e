// The lobe by which light enters a surface, to leave it elsewhere: its direction inwards has no value for light samples.
#pragma once

#include "bsdf/lobe.h"
#include "bsdf/microfacet.h"
#include "bsdf/subsurface.h"
#include "sampling/warp.h"

namespace lancer {

// Bits of lancer_lobe::option beside the method, and of Lobe::variant.
inline constexpr uint32_t kMethodBits = 3, kQuarterPixel = 4;
inline constexpr uint8_t kDimmedExit = 8; // Principled of Blender 3: light leaves with Burley's Fresnel weight

template <class F> bool is_subsurface(const Lobe<F> &lobe) { return lobe.shape == LobeShape::Subsurface; }
template <class F> SubsurfaceMethod method_of(const Lobe<F> &lobe) {
  return static_cast<SubsurfaceMethod>(lobe.variant & kMethodBits);
}

// The light below a surface as its material describes it. weight: of the light that enters, colour included; radius: in the
// user's units, by channel; alpha: of the facets that light enters by.
template <class F> struct SubsurfaceInputs {
  uint32_t option = 0;
  Rules rules = Rules::Blender45;
  Vec3<F> weight{F(0.0f)}, color{F(0.0f)}, radius{F(0.0f)};
  F ior{1.4f}, alpha{1.0f}, g{0.0f};
  bool dimmed_exit = false;
};

// Returns the mean cosine within the range of a version and a method.
template <class F> LANCER_LANE F usable_anisotropy(SubsurfaceMethod method, Rules rules, F g) {
  const bool newer = rules >= Rules::Blender52;
  return min(max(g, F(newer ? -0.99f : 0.0f)), F(newer && method == SubsurfaceMethod::RandomWalk ? 0.99f : 0.9f));
}

// The lobe keeps the colour of the surface in f90, the radius in f0, and the mean cosine in shininess.
template <class F> LANCER_LANE Lobe<F> make_subsurface(const SubsurfaceInputs<F> &in, uint8_t frame) {
  const auto method = static_cast<SubsurfaceMethod>(in.option & kMethodBits);
  Lobe<F> lobe;
  lobe.shape = LobeShape::Subsurface;
  lobe.variant = static_cast<uint8_t>(static_cast<uint32_t>(method) | (in.dimmed_exit ? kDimmedExit : 0u));
  lobe.component = Component::Diffuse;
  lobe.frame = frame;
  lobe.rules = in.rules;
  lobe.delta = uniform<F>(true);
  lobe.color = lobe.albedo = in.weight;
  lobe.f90 = in.color;
  lobe.ior = min(max(in.ior, F(1.01f)), F(3.8f));
  lobe.f0 = in.radius;
  lobe.alpha_x = method == SubsurfaceMethod::Skin ? F(1.0f) : in.alpha;
  lobe.shininess = usable_anisotropy(method, in.rules, in.g);
  return lobe;
}

// Samples the direction of entry, in the lobe's frame: evenly spread as from a diffuse surface, refracted by facets, or, for
// Skin, by either of them. Without the facets' shadowing, which Cycles leaves out. down: against the surface's own normal, for
// a profile that has no direction.
template <class F>
LANCER_LANE Vec3<F> entry_sample(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &down, F u_kind, F u, F v,
                                 MaskOf<F> &valid) {
  const SubsurfaceMethod method = method_of(lobe);
  valid = uniform<F>(true);
  if (method == SubsurfaceMethod::Burley)
    return down;
  const Vec3<F> spread = mirrored_beyond(warp_cosine_hemisphere(u, v));
  if (lobe.rules == Rules::Blender3)
    return spread;
  const Vec3<F> h = ggx_sample_visible(wo, lobe.alpha_x, lobe.alpha_x, u, v);
  const F eta = F(1.0f) / lobe.ior, cos_oh = dot(wo, h);
  const F cos_t = sqrt(max(F(1.0f) - eta * eta * (F(1.0f) - cos_oh * cos_oh), F(1e-14f)));
  const Vec3<F> refracted = (eta * cos_oh - cos_t) * h - eta * wo;
  const MaskOf<F> spreads = uniform<F>(method == SubsurfaceMethod::Skin) & (u_kind < F(0.5f));
  valid = spreads | (wo.z > F(0.0f));
  return select(spreads, spread, refracted);
}

} // namespace lancer
