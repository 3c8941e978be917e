// The Sky Texture: the radiance of the sky in a direction, by five models. Internal linkage, as in lanes.h.
//
// PREETHAM: Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight", 1999. HOSEK_WILKIE: Hosek, Wilkie, "An
// Analytic Model for Full Spectral Sky-Dome Radiance", 2012. The others interpolate a table, which sky_table.h computes, and
// add the disc of the sun.
#pragma once

#include "nodes/look_up.h"
#include "nodes/site.h"
#include "sampling/elementary.h"
#include "scene/enums.h"
#include "simd/vectors.h"

namespace lancer {
namespace {

// The elevation that the models read: by z alone, for vectors of any length. The azimuth is that of x and y.
template <class D> struct Elevation { D sine, cosine; };
template <class D> LANCER_LANE Elevation<D> elevation_of(const Vector3<D> &v) {
  const D one(1.0), z = min(max(v.z, D(-1.0)), one);
  return {z, sqrt(max((one - z) * (one + z), D(0.0)))};
}

// Returns the unit direction with this elevation and azimuth.
template <class F> LANCER_LANE Double3Of<F> sky_direction(const Vector3<F> &given) {
  using D = DoubleOf<F>;
  const Double3Of<F> v = widen(given);
  const Elevation<D> up = elevation_of(v);
  const D length = sqrt(v.x * v.x + v.y * v.y);
  const MaskOf<F> upright = length == D(0.0);
  const D scale = up.cosine / select(upright, D(1.0), length);
  return {select(upright, up.cosine, v.x * scale), v.y * scale, up.sine};
}

// The table of PREETHAM and HOSEK_WILKIE, by channel.
struct SkyCoefficients {
  const float *texels;

  LANCER_LANE glm::vec3 at(int texel) const { return {texels[3 * texel], texels[3 * texel + 1], texels[3 * texel + 2]}; }
  LANCER_LANE float of(int k, int channel) const { return texels[3 * (2 + k) + channel]; }
};

// cos_zenith: cosine of the angle from the zenith; gamma: angle from the sun.
template <class F>
LANCER_LANE F preetham_channel(const SkyCoefficients &table, int channel, const F &cos_zenith, const F &gamma,
                               const F &cos_gamma) {
  const auto c = [&](int k) { return F(table.of(k, channel)); };
  const F one(1.0f);
  return (one + c(0) * exp(c(1) / cos_zenith)) * (one + c(2) * exp(c(3) * gamma) + c(4) * cos_gamma * cos_gamma);
}
template <class F>
LANCER_LANE F hosek_wilkie_channel(const SkyCoefficients &table, int channel, const F &cos_zenith, const F &gamma,
                                   const F &cos_gamma) {
  const auto c = [&](int k) { return F(table.of(k, channel)); };
  const F one(1.0f), square = cos_gamma * cos_gamma, spread = one + c(8) * c(8) - F(2.0f) * c(8) * cos_gamma;
  const F glow = (one + square) / (spread * sqrt(spread));
  return (one + c(0) * exp(c(1) / (cos_zenith + F(0.01f)))) *
         (c(2) + c(3) * exp(c(4) * gamma) + c(5) * square + c(6) * glow + c(7) * sqrt(cos_zenith));
}

// matrix: of the node, CIE XYZ to RGB.
template <class F>
LANCER_LANE Vector3<F> analytic_sky(uint32_t model, const SkyCoefficients &table, const float *matrix,
                                    const Vector3<F> &given) {
  const Double3Of<F> d = sky_direction(given), sun(glm::dvec3(table.at(0))), beside = cross(d, sun);
  const F gamma = narrow(angle(DoubleOf<F>(sqrt(dot(beside, beside))), DoubleOf<F>(dot(d, sun)))),
          cos_gamma = narrow(dot(d, sun));
  // Below a thousandth of a radian above the horizon, the sky is as there.
  const F zero(0.0f), one(1.0f), cos_zenith = max(narrow(d.z), F(0.001f));
  const bool preetham = model == SkyModel::Preetham;
  const auto channel = [&](int k) __attribute__((always_inline)) {
    return F(table.at(1)[k]) * (preetham ? preetham_channel(table, k, cos_zenith, gamma, cos_gamma)
                                         : hosek_wilkie_channel(table, k, cos_zenith, gamma, cos_gamma));
  };
  Vector3<F> xyz(channel(0), channel(1), channel(2));
  if (preetham) {
    // From x, y, Y.
    const auto none = xyz.y == zero;
    const F each = xyz.z / select(none, one, xyz.y);
    xyz = {select(none, zero, xyz.x * each), xyz.z, select(none, zero, (one - xyz.x - xyz.y) * each)};
  } else
    xyz = F(0.0091993928f) * xyz;
  const auto row = [&](int i) __attribute__((always_inline)) {
    return F(matrix[i]) * xyz.x + F(matrix[i + 1]) * xyz.y + F(matrix[i + 2]) * xyz.z;
  };
  return {row(0), row(3), row(6)};
}

// Where the disc of the sun is seen, and its radiance there.
template <class F> struct SunDisc {
  MaskOf<F> inside;
  Vector3<F> radiance;
};
// matrix: of the node. elevation: of the direction.
template <class F>
LANCER_LANE SunDisc<F> sun_disc(bool nishita, const float *matrix, const Vector3<F> &given, const DoubleOf<F> &elevation) {
  using D = DoubleOf<F>;
  const Double3Of<F> d = widen(given), sun(glm::dvec3(matrix[6], matrix[7], matrix[8])), apart = d - sun, sum = d + sun;
  const double diameter = static_cast<double>(matrix[9]), half = 0.5 * diameter;
  const D away = D(2.0) * angle(D(sqrt(dot(apart, apart))), D(sqrt(dot(sum, sum))));
  const auto above = nishita ? given.z >= F(0.0f) : elevation > D(static_cast<double>(matrix[10]));
  const MaskOf<F> inside = (away < D(half)) & above;
  const F zero(0.0f), one(1.0f);
  if (!any(inside))
    return {inside, Vector3<F>(zero)};
  const double x = static_cast<double>(matrix[6]), y = static_cast<double>(matrix[7]), z = static_cast<double>(matrix[8]);
  const double middle = angle(z, sqrt(x * x + y * y));
  // The lower rim of NISHITA's disc is at the horizon where the ground hides a part of it.
  const bool cut = nishita && middle <= half;
  const F up = narrow(cut ? elevation / D(middle + half) : (elevation - D(middle)) / D(diameter) + D(0.5));
  const F r = narrow(away / D(half)), limb = F(0.4f) + F(0.6f) * sqrt(max(one - r * r, zero));
  const auto channel = [&](int k) __attribute__((always_inline)) {
    return limb * (F(matrix[k]) + up * F(matrix[k + 3] - matrix[k]));
  };
  return {inside, {channel(0), channel(1), channel(2)}};
}

// table: as lancer_compute_sky describes it, in RGB.
template <class F>
LANCER_LANE Vector3<F> scattering_sky(uint32_t model, const ImageView &table, const float *matrix, const Vector3<F> &given) {
  using D = DoubleOf<F>;
  const bool nishita = model == SkyModel::Nishita;
  const Double3Of<F> d = widen(given);
  const Elevation<D> height = elevation_of(d);
  const MapPlace<D> place = place_on_map(d.x, d.y, height.sine, height.cosine);
  const F zero(0.0f), half(0.5f), one(1.0f);
  // The sun is in the middle of the table, and columns go round clockwise.
  const double sun = angle(static_cast<double>(matrix[7]), static_cast<double>(matrix[6])) * 0.15915494309189535;
  const F turn = narrow(D(sun - 0.5) - place.x), u = turn - floor(turn);
  const F up = narrow(D(2.0) * place.y), root = sqrt(abs(up));
  const auto below = given.z < zero;
  const F v = nishita ? select(below, zero, root) : half + half * copysign(root, up);
  constexpr auto flags = static_cast<uint32_t>(Extension::Extend) | static_cast<uint32_t>(Interpolation::Linear) << 4;
  Vector3<F> color = look_up(image_level(table, flags), u, v).color;
  if (nishita && any(below)) {
    // Below the horizon, its light fades within 24 degrees.
    const F rest = max(one + F(2.5f) * given.z, zero);
    color = select(below, rest * rest * rest * color, color);
  }
  if (matrix[9] > 0.0f) {
    const SunDisc<F> disc = sun_disc(nishita, matrix, given, D(D(3.141592653589793) * place.y));
    color = select(disc.inside, nishita ? disc.radiance : color + disc.radiance, color);
  }
  return color;
}

template <class F> Value<F> sky_node(const Inputs<F> &in) {
  const ImageView &table = in.images[in.node.image];
  const SkyCoefficients coefficients{reinterpret_cast<const float *>(table.texels)};
  const Vector3<F> color = in.node.option <= SkyModel::HosekWilkie
                               ? analytic_sky(in.node.option, coefficients, in.node.matrix, in[0])
                               : scattering_sky(in.node.option, table, in.node.matrix, in[0]);
  // Colours outside the gamut are negative in some channel. A number that is no number becomes 0, too.
  return solid(max(Vector3<F>(F(0.0f)), color));
}

} // namespace
} // namespace lancer
