// Beckmann's distribution of microfacets: density, masking, and sampling of the normals visible from wo.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sampling/elementary.h"
#include "sampling/warp.h"
#include "simd/vectors.h"

namespace lancer {

// D: density of microfacet normals per solid angle, anisotropic along the frame's axes; h.z > 0. Below exp(-87) of its maximum
// it is 0 in float.
template <class F> LANCER_LANE F beckmann_d(const Vec3<F> &h, F alpha_x, F alpha_y) {
  const F x = h.x / alpha_x, y = h.y / alpha_y, z2 = h.z * h.z, exponent = (x * x + y * y) / z2;
  return select(exponent <= 87.0f, exp(-exponent) * kInvPi / (alpha_x * alpha_y * z2 * z2), F(0.0f));
}

// Returns the tangential length of a direction after scaling facets of that roughness to roughness 1.
template <class F> LANCER_LANE F squeezed(const Vec3<F> &w, F alpha_x, F alpha_y) {
  const F x = alpha_x * w.x, y = alpha_y * w.y;
  return sqrt(x * x + y * y);
}

// The masking parameter a = 1 / (alpha tan(theta)); infinite along n.
template <class F> LANCER_LANE F beckmann_a(const Vec3<F> &w, F alpha) { return w.z / (alpha * sqrt(w.x * w.x + w.y * w.y)); }

// Walter's rational fit of G1 ("Microfacet models for refraction through rough surfaces", 2007): a (first + second a) over
// 1 + a (third + fourth a).
namespace walter {
inline constexpr double kFirst = 3.535, kSecond = 2.181, kThird = 2.276, kFourth = 2.577;
}

// The fit of G1, which CLASSIC uses as its value; the fit exceeds 1 just below its end.
template <class F> LANCER_LANE F beckmann_g1(F a) {
  using namespace walter;
  const F fit = min(F(1.0f), a * (float(kFirst) + float(kSecond) * a) / (1.0f + a * (float(kThird) + float(kFourth) * a)));
  return select(a < 1.6f, fit, F(1.0f));
}

// The area of facets hidden from w, Smith's Lambda times |cos|, by the same fit: Lambda = 1 / G1 - 1. As in Cycles, it is
// exactly 0 for small slopes.
template <class F> LANCER_LANE F beckmann_hidden(const Vec3<F> &w, F alpha_x, F alpha_y) {
  using namespace walter;
  const F along = squeezed(w, alpha_x, alpha_y), a = abs(w.z) / along;
  const F fit = along * max(F(0.0f), (1.0f + a * (float(kFourth - kSecond) * a - float(kFirst - kThird))) /
                                         (float(kFirst) + float(kSecond) * a));
  return select(a * a * 0.39f <= F(1.0f), fit, F(0.0f));
}

// Beyond this a, masking removes less than erfc(4) = 2e-8, below the precision of float.
inline constexpr float kUnmasked = 4.0f;

// The exact G1, with which the density of visible normals integrates to 1.
template <class F> LANCER_LANE F beckmann_g1_exact(F a) {
  const auto masked = a < kUnmasked;
  if (!any(masked))
    return F(1.0f);
  constexpr float inv_2_sqrt_pi = 0.5f * std::numbers::inv_sqrtpi_v<float>;
  // Use a common denominator, so that a = 0 causes no division by zero.
  return select(masked, a / (a + inv_2_sqrt_pi * exp(-a * a) - 0.5f * a * erfc(a)), F(1.0f));
}

// Samples the slope along wo's azimuth, in units of alpha, of a normal visible from masking parameter a: density (a - x)
// exp(-x^2), x < a.
inline double beckmann_visible_slope(float a_float, float u_float) {
  constexpr double half_sqrt_pi = 0.5 / std::numbers::inv_sqrtpi_v<double>;
  const double a = a_float;
  // Use the middle of the float's cell: u = 0 would select the end of an infinite tail.
  const double u = static_cast<double>(u_float) + 0x1p-25;
  const auto integral = [&](double x, double exp_x2) { return a * half_sqrt_pi * erfc(-x) + 0.5 * exp_x2; };
  const double total = integral(a, exp(-a * a));
  // Start from a power law between both ends of erf(x), within 0.03 of the root.
  const double top = erf(a);
  const double k = 0.43 + 0.57 * a * a / (a * a + 5.0);
  const double start = top - (1.0 + top) * exp(k * log(1.0 - u));
  double low = -6.0, high = a;
  double x = std::clamp(static_cast<double>(erf_inverse(static_cast<float>(std::clamp(start, -1.0 + 0x1p-23, 1.0 - 0x1p-23)))),
                        low, high);
  for (int i = 0; i < 60; ++i) {
    const double exp_x2 = exp(-x * x);
    const double error = integral(x, exp_x2) / total - u;
    if (std::abs(error) < 0x1p-30)
      break;
    (error > 0.0 ? high : low) = x;
    // Take Halley's step, or halve the bracket if the step would leave it.
    const double slope = (a - x) * exp_x2 / total;
    const double newton = error / slope;
    const double step = newton / (1.0 + newton * (0.5 / (a - x) + x));
    const double next = x - step;
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return x;
}

// Samples the angle phi between wo's azimuth and a slope of length r = eccentricity * a, with density (1 - eccentricity
// cos(phi)) / (2 pi). The distribution function is Kepler's equation, phi - eccentricity sin(phi) = mean anomaly.
inline float beckmann_visible_angle(float eccentricity, float u) {
  const float mean = kPi * std::abs(2.0f * u - 1.0f);
  // Newton's method from above: the function is convex between 0 and pi, so every step decreases towards the root.
  float phi = std::min(mean + eccentricity, kPi);
  for (int i = 0; i < 20; ++i) {
    const float error = phi - eccentricity * sin(phi) - mean;
    const float step = error / (1.0f - eccentricity * cos(phi));
    if (!(step > 0x1p-22f * phi))
      break;
    phi -= step;
  }
  return std::copysign(phi, 2.0f * u - 1.0f);
}

// Samples a normal h visible from wo (wo.z > 0), with density G1_exact(wo) max(0, wo.h) D(h) / wo.z per solid angle of h.
template <class F> LANCER_LANE Vec3<F> beckmann_sample_visible(const Vec3<F> &wo, F alpha_x, F alpha_y, F u, F v) {
  // Scale the facets, together with wo, to roughness 1.
  const F along = alpha_x * wo.x, across = alpha_y * wo.y;
  const F sin_theta = sqrt(along * along + across * across);
  const F a = wo.z / sin_theta;
  const auto tilted = sin_theta > 0.0f;
  const F azimuth_x = select(tilted, along / sin_theta, F(1.0f)), azimuth_y = select(tilted, across / sin_theta, F(0.0f));
  // Sample the slope along wo's azimuth and across it.
  F slope_x(0.0f), slope_y(0.0f);
  const auto masked = a < kUnmasked;
  if (any(masked)) {
    // Along wo's azimuth by visibility; across it Gaussian.
    slope_x = each(a, u, [](float of, float number) {
      return of < kUnmasked ? static_cast<float>(beckmann_visible_slope(of, number)) : 0.0f;
    });
    slope_y = erf_inverse(2.0f * v + (0x1p-24f - 1.0f));
  }
  if (any(!masked)) {
    // Without masking: length from a Gaussian (log1p keeps the digits of small u), angle by projected area alone.
    const F r = sqrt(-log1p(-u));
    const F phi = each(min(r / a, F(1.0f)), v, beckmann_visible_angle);
    slope_x = select(masked, slope_x, r * cos(phi));
    slope_y = select(masked, slope_y, r * sin(phi));
  }
  // Rotate the slope to wo's azimuth and scale it back; the normal tilts against the slope.
  const F x = alpha_x * (azimuth_x * slope_x - azimuth_y * slope_y);
  const F y = alpha_y * (azimuth_y * slope_x + azimuth_x * slope_y);
  return normalize(Vec3<F>(-x, -y, F(1.0f)));
}

} // namespace lancer
