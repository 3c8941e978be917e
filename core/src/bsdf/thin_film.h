// Interference in a thin film on a dielectric or a metal (Belcour and Barla 2017): light that has crossed the film once or
// several times adds to what its upper boundary reflects, by the phase of its longer path. Included by fresnel.h only.
#pragma once

#include "bsdf/albedo_tables.h"
#include "bsdf/fresnel.h"
#include "bsdf/thin_film_table.h"
#include "sampling/warp.h"

namespace lancer {

// A film of at most this thickness, in nanometres, is none, as in Cycles.
inline constexpr float kThinnestFilm = 0.1f;
// Indices beyond this, of films and of metals below them, have the same effect, and powers that leave the range of float.
inline constexpr float kDensest = 1e4f;

template <class F> struct ThinFilm { F thickness, ior; };

// The film is stored where the curve of its facets needs no vector.
template <class F> LANCER_LANE ThinFilm<F> film_of(const Lobe<F> &lobe) {
  const Vec3<F> &stored = lobe.fresnel == FresnelKind::F82 ? lobe.f90 : lobe.b;
  return {stored.x, stored.y};
}

// Puts a film on facets whose curve is set; ior as seen from wo's side.
template <class F> LANCER_LANE void set_film(Lobe<F> &lobe, F thickness, F ior) {
  lobe.film = true;
  (lobe.fresnel == FresnelKind::F82 ? lobe.f90 : lobe.b) = Vec3<F>(thickness, ior, F(0.0f));
}

// The boundary of a dielectric by polarisation: reflectances, and signs of the amplitudes.
template <class F> struct Polarized {
  F s, p, sign_s, sign_p;
  F cos_t;           // cosine of the refracted direction
  MaskOf<F> mirrors; // reflects everything
};

// cos_i and eta: see fresnel().
template <class F> LANCER_LANE Polarized<F> polarized(F cos_i, F eta) {
  using D = DoubleOf<F>;
  const D c = min(max(widen(cos_i), D(0.0)), D(1.0));
  const D n = widen(eta), e = D(1.0) / n;
  const D cos2_t = (n - D(1.0)) * e * ((n + D(1.0)) * e) + (e * c) * (e * c);
  const D g = sqrt(max(cos2_t, D(0.0)));
  const F rs = narrow((e * c - g) / (e * c + g)), rp = narrow((c - e * g) / (c + e * g));
  const F zero(0.0f), one(1.0f);
  const MaskOf<F> grazing = c == D(0.0), total = !(cos2_t > D(0.0)), mirrors = grazing | total;
  return {rs * rs, rp * rp, select(rs >= zero, one, -one), select(rp >= zero, one, -one), narrow(g), mirrors};
}

template <class F> struct Phasor { F re, im; };

// The boundary of a metal of index n + i k below a medium of index outside: reflectances and phases by polarisation. Born and
// Wolf, Principles of Optics, 14.4.1. edge: reflectance at 82 degrees, of F82 alone.
template <class F> struct PolarizedMetal {
  F s, p;
  Phasor<F> phase_s, phase_p;
};
template <class F> LANCER_LANE PolarizedMetal<F> polarized_metal(F cos_i, F outside, F n, F k, F edge, bool f82) {
  const F zero(0.0f), one(1.0f), c = clamp01(cos_i), o2 = outside * outside, oc = outside * c;
  const F re = (n - k) * (n + k), im = 2.0f * n * k, t = re - o2 * ((1.0f - c) * (1.0f + c));
  const F length = hypot(t, im);
  const F u2 = max(0.5f * (length + t), zero), v2 = max(0.5f * (length - t), zero);
  const F u = sqrt(u2), v = sqrt(v2);
  const auto square = [](F x) __attribute__((always_inline)) { return x * x; };
  PolarizedMetal<F> metal;
  if (f82) {
    const F rn = n / outside, rk2 = square(k / outside);
    const F f0 = (square(rn - one) + rk2) / (square(rn + one) + rk2);
    const F b = F(kEdgeScale) * (f0 + (one - f0) * F(kFifth) - edge);
    metal.s = metal.p = fresnel_f82(c, Vec3<F>(f0), Vec3<F>(b)).x;
  } else {
    metal.s = quotient(square(oc - u) + v2, square(oc + u) + v2);
    metal.p = quotient(square(re * c - outside * u) + square(im * c - outside * v),
                       square(re * c + outside * u) + square(im * c + outside * v));
  }
  const auto phase = [&](F x, F y) __attribute__((always_inline))->Phasor<F> {
    const F size = hypot(x, y);
    return {select(size > zero, x / size, one), select(size > zero, y / size, zero)};
  };
  metal.phase_s = phase(square(oc) - u2 - v2, -2.0f * oc * v);
  metal.phase_p = phase(square((n * n + k * k) * c) - o2 * (u2 + v2), 2.0f * oc * (im * u - re * v));
  return metal;
}

// The colour by which light of an optical path difference adds to that without: of cosine and sine of its phase at reflection.
template <class F> struct FilmColor { Vec3<F> re, im; };

// Table lookup of the colour matching functions, from Blender 5.0 on.
template <class F> LANCER_LANE FilmColor<F> film_color(F path) {
  constexpr int n = kFilmNodes;
  const tables::AxisPlace<F> at = tables::place_on_axis(path * (2.0f * kPi / kFilmLength), n);
  const WordOf<F> first = truncate(at.node);
  F part[3][2];
  for (int channel = 0; channel < 3; ++channel) {
    const WordOf<F> low = gather(kFilmColors[channel], first), high = gather(kFilmColors[channel] + 1, first);
    constexpr float scale = 1.0f / (65536.0f * kFilmScale);
    const WordOf<F> upper(0xffff0000u);
    part[channel][0] = scale * tables::between(at, to_float(low << 16), to_float(high << 16));
    part[channel][1] = scale * tables::between(at, to_float(low & upper), to_float(high & upper));
  }
  return {{part[0][0], part[1][0], part[2][0]}, {part[0][1], part[1][1], part[2][1]}};
}

// Sums of Gaussians for X, Y and Z, before Blender 5.0; phases at reflection are 0 or a half turn, so that the sine is not
// needed.
template <class F> LANCER_LANE Vec3<F> film_color_of_gaussians(F path) {
  // Beyond 30 micrometres nothing is left.
  const F x = (2.0f * kPi * 1e-9f) * min(path, F(3e4f)), x2 = x * x;
  const auto bell = [&](float height, float place, float variance) __attribute__((always_inline)) {
    return height * cos(place * x) * exp(-variance * x2);
  };
  // Heights are val sqrt(2 pi var) / 1.0685e-7 of the authors' fit.
  const F red = bell(0.84659000f, 1.6810e6f, 4.3278e9f) + bell(0.15386804f, 2.2399e6f, 4.5282e9f);
  const F green = bell(1.00022189f, 1.7953e6f, 9.3046e9f), blue = bell(1.00112249f, 2.2084e6f, 6.6121e9f);
  // Scale to the white of Rec. 709, and convert to its primaries.
  const Vec3<F> xyz(0.95047f * red, green, 1.08883f * blue);
  return {3.2404542f * xyz.x - 1.5371385f * xyz.y - 0.4985314f * xyz.z,
          -0.9692660f * xyz.x + 1.8760108f * xyz.y + 0.0415560f * xyz.z,
          0.0556434f * xyz.x - 0.2040259f * xyz.y + 1.0572252f * xyz.z};
}

// The colours of light that has crossed the film once, twice and three times; further crossings hardly matter.
inline constexpr int kFilmCrossings = 3;

// Sums one polarisation and channel. top, bottom: reflectances of the boundaries; phase: of both reflections.
template <class F>
LANCER_LANE F film_sum(F top, F bottom, Phasor<F> phase, const F (&re)[kFilmCrossings], const F (&im)[kFilmCrossings]) {
  const F through = 1.0f - top, both = top * bottom, ratio = sqrt(both);
  const F returned = select(both < F(1.0f), through * through * bottom / (1.0f - both), F(0.0f));
  F sum = top + returned, share = returned - through;
  Phasor<F> turned = phase;
  for (int m = 0; m < kFilmCrossings; ++m) {
    share *= ratio;
    sum += share * 2.0f * (turned.re * re[m] + turned.im * im[m]);
    turned = {turned.re * phase.re - turned.im * phase.im, turned.im * phase.re + turned.re * phase.im};
  }
  return sum;
}

// Changes the response of facets that have a film, where it is thick enough.
template <class F> void add_film(const Lobe<F> &lobe, F cos_i, FacetResponse<F> &response) {
  using V = Vec3<F>;
  const F zero(0.0f), one(1.0f);
  const ThinFilm<F> film = film_of(lobe);
  const MaskOf<F> there = film.thickness > kThinnestFilm;
  if (!any(there))
    return;
  // The effect of a film fades as its thickness vanishes.
  const bool by_table = lobe.rules >= Rules::Blender50;
  const F rise = clamp01(film.thickness / (by_table ? 1.0f : 30.0f)), shown = rise * rise * (3.0f - 2.0f * rise);
  const F given = min(film.ior, F(kDensest)), ior = select(rise < one, one + (given - one) * shown, given);
  const Polarized<F> top = polarized(abs(cos_i), ior);
  const F path = 2.0f * ior * film.thickness * top.cos_t;
  F re[3][kFilmCrossings], im[3][kFilmCrossings];
  for (int m = 0; m < kFilmCrossings; ++m) {
    const F longer = float(m + 1) * path;
    const FilmColor<F> color = by_table ? film_color(longer) : FilmColor<F>{film_color_of_gaussians(longer), V(zero)};
    const V &r = color.re, &i = color.im;
    const F res[3] = {r.x, r.y, r.z}, ims[3] = {i.x, i.y, i.z};
    for (int channel = 0; channel < 3; ++channel) {
      re[channel][m] = res[channel];
      im[channel][m] = ims[channel];
    }
  }
  F sum[3];
  if (lobe.fresnel == FresnelKind::Schlick) {
    const Polarized<F> bottom = polarized(top.cos_t, lobe.ior / ior);
    const MaskOf<F> mirrors = top.mirrors | bottom.mirrors;
    for (int channel = 0; channel < 3; ++channel) {
      const F s = film_sum(top.s, bottom.s, {-top.sign_s * bottom.sign_s, zero}, re[channel], im[channel]);
      const F p = film_sum(top.p, bottom.p, {-top.sign_p * bottom.sign_p, zero}, re[channel], im[channel]);
      sum[channel] = select(mirrors, one, clamp01(0.5f * (s + p)));
    }
    // Scale the reflectance by that of f0 over the index's own, the less the closer it is to 1.
    V reflected(sum[0], sum[1], sum[2]);
    const F own = f0_of_ior(lobe.ior);
    const MaskOf<F> scales = (own > 1e-5f) & (own < one) & !same(reflected, V(one));
    const auto scaled = [&](F f, F f0) __attribute__((always_inline)) {
      const F near = clamp01((f - one) / (own - one));
      // A tint above 1 may ask for more light than there is.
      return select(scales, clamp01(f * (one + (f0 / own - one) * near)), f);
    };
    reflected = {scaled(reflected.x, lobe.f0.x), scaled(reflected.y, lobe.f0.y), scaled(reflected.z, lobe.f0.z)};
    if (refracts(lobe))
      response.through = select(there, (V(one) - reflected) * lobe.transmission, response.through);
    response.reflected = select(there, reflects(lobe) ? reflected * lobe.reflection : V(zero), response.reflected);
    return;
  }
  V n = lobe.f0, k = lobe.f90, edge(zero);
  const bool f82 = lobe.fresnel == FresnelKind::F82;
  if (f82) {
    // The index whose curve has these values at the normal and at 82 degrees (Gulbrandsen 2014).
    const V r = min(lobe.f0, V(F(0.999f))), root = sqrt(r);
    edge = fresnel_f82(F(1.0f / 7.0f), lobe.f0, lobe.b);
    n = (V(one) + root) / (V(one) - root);
    n += ((V(one) - r) / (V(one) + r) - n) * edge;
    const V n2 = (n + V(one)) * (n + V(one)), n1 = (n - V(one)) * (n - V(one));
    k = sqrt(max((r * n2 - n1) / (V(one) - r), V(zero)));
  }
  const F limit(kDensest);
  const V densest(limit), bounded_n = min(n, densest), bounded_k = min(k, densest);
  const F ns[3] = {bounded_n.x, bounded_n.y, bounded_n.z}, ks[3] = {bounded_k.x, bounded_k.y, bounded_k.z},
          edges[3] = {edge.x, edge.y, edge.z};
  for (int channel = 0; channel < 3; ++channel) {
    const PolarizedMetal<F> bottom = polarized_metal(top.cos_t, ior, ns[channel], ks[channel], edges[channel], f82);
    const auto turned = [](const Phasor<F> &phase, F sign) __attribute__((always_inline))->Phasor<F> {
      return {-sign * phase.re, -sign * phase.im};
    };
    const F s = film_sum(top.s, bottom.s, turned(bottom.phase_s, top.sign_s), re[channel], im[channel]);
    const F p = film_sum(top.p, bottom.p, turned(bottom.phase_p, top.sign_p), re[channel], im[channel]);
    sum[channel] = select(top.mirrors, one, clamp01(0.5f * (s + p)));
  }
  response.reflected = select(there, V(sum[0], sum[1], sum[2]), response.reflected);
}

} // namespace lancer
