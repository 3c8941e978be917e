// Light below a surface: the medium that gives a surface its colour, the direction of entry, and the steps of a random walk.
//   "Practical and Controllable Subsurface Scattering for Production Path Tracing", Chiang, Kutz, Burley 2016;
//   "Path Traced Subsurface Scattering using Anisotropic Phase Functions and Non-Exponential Free Flights", Wrenninge,
//   Villemin, Hery 2017; "A Zero-variance-based Sampling Scheme for Monte Carlo Subsurface Scattering", Krivanek, d'Eon 2014,
//   with "Improving the Dwivedi Sampling Scheme", Meng, Hanika, Dachsbacher 2016, and "Zero-Variance Theory for Efficient
//   Subsurface Scattering", d'Eon, Krivanek 2020; "A Hitchhiker's Guide to Multiple Scattering", d'Eon.
#pragma once

#include "bsdf/lobe.h"
#include "sampling/elementary.h"
#include "sampling/warp.h"

namespace lancer {

// Radii below this are those of a diffuse surface, in the user's units.
inline constexpr float kSmallestRadius = 1e-8f;

// Returns the albedo of a medium whose dipole reflects a share r of the light. four_thirds_a: 4 / 3 times A of Jensen et al.
// 2001.
template <class F> F dipole_albedo(F r, F four_thirds_a) {
  // Bisect the share, which grows with the albedo, as often as Cycles does.
  F low(0.0f), high(1.0f), middle(0.5f);
  for (int i = 0; i < 12; ++i) {
    middle = F(0.5f) * (low + high);
    const F s = sqrt(F(3.0f) * (F(1.0f) - middle));
    const F share = F(0.5f) * middle * (F(1.0f) + exp(-four_thirds_a * s)) * exp(-s);
    const MaskOf<F> below = share < r;
    low = select(below, middle, low);
    high = select(below, high, middle);
  }
  return select(r < F(1e-4f), F(0.0f), select(r >= F(0.995f), F(0.999999f), middle));
}

// Returns the radius that Cycles uses for a method: in units of the mean free path of older profiles, or adjusted by index and
// colour so that the visible blur keeps its size.
template <class F>
LANCER_LANE Vec3<F> walking_radius(SubsurfaceMethod method, const Vec3<F> &radius, const Vec3<F> &albedo, F ior) {
  if (method == SubsurfaceMethod::RandomWalk)
    return radius;
  if (method != SubsurfaceMethod::Skin)
    return radius * (0.25f * kInvPi);
  const F eta = F(1.0f) / ior;
  const F reflectance = eta * (F(-1.44f) * eta + F(0.71f)) + F(0.668f) + F(0.0636f) * ior;
  const F a = F(4.0f / 3.0f) * (F(1.0f) + reflectance) / (F(1.0f) - reflectance);
  const auto scale = [&](F x) { return sqrt(F(3.0f) * (F(1.0f) - dipole_albedo(x, a))); };
  return {radius.x * scale(albedo.x), radius.y * scale(albedo.y), radius.z * scale(albedo.z)};
}

// A homogeneous medium: attenuation per unit of length, albedo of one scattering, and the mean cosine of scattering.
template <class F> struct Medium {
  Vec3<F> sigma_t{F(1.0f)}, albedo{F(0.0f)};
  F g{0.0f};
};

// Returns the albedo of one scattering for a surface of this colour: the fit of Wrenninge et al.
template <class F> LANCER_LANE F fitted_albedo(F color, F g) {
  const auto polynomial = [&](const float(&c)[8]) {
    F sum(c[7]);
    for (int i = 6; i >= 0; --i)
      sum = sum * g + F(c[i]);
    return sum;
  };
  const F a = polynomial({1.8260523782f, -1.28451056436f, -1.79904629312f, 9.19393289202f, -22.8215585862f, 32.0234874259f,
                          -23.6264803333f, 7.21067002658f});
  const F b = F(4.98511194385f) +
              F(0.127355959438f) * exp(polynomial({0.0f, 31.1491581433f, -201.847017512f, 841.576016723f, -2018.09288505f,
                                                   2731.71560286f, -1935.41424244f, 559.009054474f}));
  const F c = polynomial({1.09686102424f, -0.394704063468f, 1.05258115941f, -8.83963712726f, 28.8643230661f, -46.8802913581f,
                          38.5402837518f, -12.7181042538f});
  const F d = polynomial({0.496310210422f, 0.360146581622f, -2.15139309747f, 17.8896899217f, -55.2984010333f, 82.065982243f,
                          -58.5106008578f, 15.8478295021f});
  const F e = F(4.23190299701f) +
              F(0.00310603949088f) * exp(polynomial({0.0f, 76.7316253952f, -594.356773233f, 2448.8834203f, -5576.68528998f,
                                                     7116.60171912f, -4763.54467887f, 1303.5318055f}));
  const F f = polynomial({2.40602999408f, -2.51814844609f, 9.18494908356f, -79.2191708682f, 259.082868209f, -403.613804597f,
                          302.85712436f, -87.4370473567f});
  const F blend = sqrt(sqrt(color));
  return (F(1.0f) - blend) * a * pow(atan(F(b * color)), c) + blend * d * pow(atan(F(e * color)), f);
}

// The same by d'Eon's equation 53.7, for any g.
template <class F> LANCER_LANE F similar_albedo(F color, F g) {
  const F s = F(4.20863f) * color - sqrt(F(9.59217f) + F(41.6808f) * color + F(17.7126f) * color * color) + F(4.09712f);
  const F square = s * s, divisor = F(1.0f) - g * square;
  return select(divisor != F(0.0f), (F(1.0f) - square) / divisor, F(0.0f));
}

// Returns the medium of a surface's colour and radius. weight: divided by the colour, which the walk gives; dark channels
// scatter more than their colour says, and their weight makes up for it.
template <class F>
LANCER_LANE Medium<F> medium_below(SubsurfaceMethod method, const Vec3<F> &color, const Vec3<F> &radius, F g, Vec3<F> &weight) {
  const F zero(0.0f), one(1.0f), least(0.2f);
  const MaskOf<F> fitted = uniform<F>(method != SubsurfaceMethod::RandomWalk) & (g >= zero);
  Medium<F> medium;
  medium.g = g;
  const auto channel = [&](F c, F r, F &sigma, F &albedo, F &w) {
    const F by_fit = any(fitted) ? fitted_albedo(c, g) : zero;
    const F raw = min(F(0.999999f), max(zero, select(fitted, by_fit, similar_albedo(c, g))));
    sigma = one / max(r, F(1e-16f)) / select(fitted, one - g, one);
    const MaskOf<F> dark = raw < least;
    albedo = select(dark, least, raw);
    w = select(c != zero, w / c, zero) * select(dark, raw / least, one);
  };
  channel(color.x, radius.x, medium.sigma_t.x, medium.albedo.x, weight.x);
  channel(color.y, radius.y, medium.sigma_t.y, medium.albedo.y, weight.y);
  channel(color.z, radius.z, medium.sigma_t.z, medium.albedo.z, weight.z);
  return medium;
}

// Henyey and Greenstein's phase function of the cosine to the direction of travel, per solid angle.
template <class F> LANCER_LANE F henyey_greenstein(F cosine, F g) {
  const F base = F(1.0f) + g * g - F(2.0f) * g * cosine;
  return F(0.25f * kInvPi) * (F(1.0f) - g * g) / (base * sqrt(base));
}
template <class F> LANCER_LANE F henyey_greenstein_sample(F g, F u) {
  const F even = F(1.0f) - F(2.0f) * u, k = (F(1.0f) - g * g) / (F(1.0f) - g + F(2.0f) * g * u);
  return select(abs(g) < F(1e-3f), even, max(F(-1.0f), min(F(1.0f), (F(1.0f) + g * g - k * k) / (F(2.0f) * g))));
}

// Returns the length v over which light fades with depth, which guides the walk to the surface: d'Eon and Krivanek,
// equation 67.
template <class F> LANCER_LANE F diffusion_length(F albedo) {
  const F power = F(2.44294f) - F(0.0215813f) * albedo + F(0.578637f) / albedo;
  return F(1.0f) / sqrt(F(1.0f) - pow(albedo, power));
}
// Dwivedi's density of the cosine to the outward normal, and a sample of it; log_v: log((v + 1) / (v - 1)).
template <class F> LANCER_LANE F dwivedi_pdf(F v, F log_v, F cosine) { return F(1.0f) / ((v - cosine) * log_v); }
template <class F> LANCER_LANE F dwivedi_sample(F v, F log_v, F u) { return v - (v + F(1.0f)) * exp(-u * log_v); }

// Returns the direction at a cosine to an axis, u turns around it.
template <class F> LANCER_LANE Vec3<F> around(const Vec3<F> &axis, F cosine, F u) {
  const F sine = sqrt(max(F(0.0f), (F(1.0f) - cosine) * (F(1.0f) + cosine)));
  const SinCos<F> turn = sin_cos_turn(u);
  return Frame<F>(axis).to_world({sine * turn.cos, sine * turn.sin, cosine});
}

// Burley's profile of light that leaves at distance r from its entry, per area times 2 pi r, cut off at 16 d:
// "Approximate Reflectance Profiles for Efficient Subsurface Scattering", Christensen, Burley 2015.
inline constexpr float kBurleyReach = 16.0f, kBurleyWithin = 0.9963790093708328f;
template <class F> LANCER_LANE F burley_profile(F d, F r) {
  const F third = exp(-r / (F(3.0f) * d));
  const F value = (third * third * third + third) / (F(4.0f) * d) * F(1.0f / kBurleyWithin);
  return select((r > F(0.0f)) & (r < F(kBurleyReach) * d), value, F(0.0f));
}
// Returns r of a share u of the light, by Newton's method from a fitted start, for d = 1.
inline float burley_radius(float u) {
  const float share = u * kBurleyWithin;
  float r = share <= 0.9f ? exp(share * share * 2.4f) - 1.0f : 15.0f;
  for (int i = 0; i < 10; ++i) {
    const float third = exp(-r / 3.0f), whole = third * third * third;
    const float off = 1.0f - 0.25f * whole - 0.75f * third - share, slope = 0.25f * whole + 0.25f * third;
    if (std::abs(off) < 1e-6f || slope == 0.0f)
      break;
    r = std::max(r - off / slope, 0.0f);
  }
  return r;
}

} // namespace lancer
