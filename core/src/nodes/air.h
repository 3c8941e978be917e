// The air of two models of an atmosphere: its constants, and its density by height. Internal linkage, as in lanes.h.
#pragma once

#include "sampling/elementary.h"
#include "simd/vectors.h"

namespace lancer {
namespace {

// Single scattering: Nishita et al., "Display of the Earth Taking into Account Atmospheric Scattering", 1993, in 21 wavelengths
// from 380 to 780 nm. Lengths are in metres.
namespace single {

constexpr double kGround = 6360e3, kTop = 6420e3; // radii
constexpr double kHighest = 59999.0;              // altitude of an observer
constexpr float kAirScale = 8000.0f, kAerosolScale = 1200.0f, kOzoneHeight = 25000.0f, kOzoneHalf = 15000.0f;
constexpr float kAerosols = 2e-5f, kAerosolExtinction = 1.11f * kAerosols;
constexpr float kForward = 0.76f; // anisotropy of aerosols
// Gauss-Laguerre quadrature over the ray towards the sun, whose length is 1, for densities that fall as exp(-25 x): nodes, and
// weights over exp(-25 x).
constexpr int kNodes = 8;
constexpr float kNode[kNodes] = {0.0068111853f, 0.036148071f, 0.090043465f, 0.17066801f,
                                 0.28183622f,   0.43034064f,  0.62962715f,  0.91452527f};
constexpr float kWeight[kNodes] = {0.017508936f, 0.041354774f, 0.066788391f, 0.095076988f,
                                   0.12834164f,  0.17074302f,  0.23272333f,  0.35624905f};
constexpr int kWaves = 21;
constexpr float kWaveStep = 20.0f; // nm

// Irradiance of the sun above the atmosphere, W / (m^2 nm).
constexpr float kSun[kWaves] = {1.4575683f, 1.5659631f, 1.6514845f, 1.7149624f, 1.7579798f, 1.7825641f, 1.7909511f,
                                1.7854134f, 1.7681555f, 1.7412207f, 1.7064713f, 1.6655609f, 1.6199344f, 1.5708360f,
                                1.5193233f, 1.4662850f, 1.4124585f, 1.3584497f, 1.3047491f, 1.2517496f, 1.1997600f};
// Scattering of air and absorption of ozone at the ground, per metre.
constexpr float kAir[kWaves] = {5.4248201e-05f, 4.4185499e-05f, 3.6351519e-05f, 3.0179290e-05f, 2.5263202e-05f, 2.1308593e-05f,
                                1.8098380e-05f, 1.5470571e-05f, 1.3302850e-05f, 1.1501848e-05f, 9.9955743e-06f, 8.7279997e-06f,
                                7.6551370e-06f, 6.7421720e-06f, 5.9613413e-06f, 5.2903460e-06f, 4.7111569e-06f, 4.2091048e-06f,
                                3.7721838e-06f, 3.3905126e-06f, 3.0559153e-06f};
constexpr float kOzone[kWaves] = {
    3.2512685e-09f, 5.8539537e-09f, 1.9771912e-08f, 7.3095688e-08f, 2.0084562e-07f, 4.0383958e-07f, 6.3551336e-07f,
    9.6707041e-07f, 1.5479740e-06f, 2.0903865e-06f, 2.4612806e-06f, 2.7355130e-06f, 2.1512586e-06f, 1.5905184e-06f,
    1.1235620e-06f, 7.3527551e-07f, 4.6450130e-07f, 3.3096080e-07f, 2.2512612e-07f, 1.4879129e-07f, 1.6828623e-07f};
// Colour matching functions of CIE 1931.
constexpr float kXyz[kWaves][3] = {{0.001368f, 3.9e-05f, 0.006450001f},
                                   {0.01431f, 0.000396f, 0.06785001f},
                                   {0.13438f, 0.004f, 0.6456f},
                                   {0.34828f, 0.023f, 1.74706f},
                                   {0.2908f, 0.06f, 1.6692f},
                                   {0.09564f, 0.13902f, 0.8129501f},
                                   {0.0049f, 0.323f, 0.272f},
                                   {0.06327f, 0.71f, 0.07824999f},
                                   {0.2904f, 0.954f, 0.0203f},
                                   {0.5945f, 0.995f, 0.0039f},
                                   {0.9163f, 0.87f, 0.00165f},
                                   {1.0622f, 0.631f, 0.0008f},
                                   {0.8544499f, 0.381f, 0.00019f},
                                   {0.4479f, 0.175f, 2e-05f},
                                   {0.1649f, 0.061f, 0.0f},
                                   {0.04677f, 0.017f, 0.0f},
                                   {0.01135916f, 0.004102f, 0.0f},
                                   {0.002899327f, 0.001047f, 0.0f},
                                   {0.0006900786f, 0.0002492f, 0.0f},
                                   {0.0001661505f, 6e-05f, 0.0f},
                                   {4.150994e-05f, 1.499e-05f, 0.0f}};

// Densities of air, aerosols and ozone, relative to the ground's, for ozone to its largest.
template <class F> struct Densities { F air, aerosols, ozone; };
template <class F> LANCER_LANE Densities<F> densities_at(const F &height) {
  const F ozone = F(1.0f) - abs(height - F(kOzoneHeight)) / F(kOzoneHalf);
  return {exp(-height / F(kAirScale)), exp(-height / F(kAerosolScale)), max(ozone, F(0.0f))};
}

} // namespace single

// Multiple scattering: a fit to path-traced skies by Garcia Linan, "Real-time rendering of the Earth's atmosphere", 2022, in
// four wavelengths: 630, 560, 490 and 430 nm. Lengths are in kilometres.
namespace multiple {

constexpr double kGround = 6371.0, kThickness = 100.0;
constexpr double kHighest = 99.999;
constexpr float kForward = 0.8f;
constexpr float kGroundAlbedo = 0.3f;
constexpr float kSun[4] = {1.679f, 1.828f, 1.986f, 1.307f};
// Scattering of air at the ground; absorption of ozone times its column; absorption and scattering of aerosols of an urban
// area. Per kilometre, and per kilometre and relative density.
constexpr double kOzoneColumn = 334.5 * 3.78547397e20, kAerosolColumn = 1.3681e20;
constexpr float kAir[4] = {6.605e-3f, 1.067e-2f, 1.842e-2f, 3.156e-2f};
constexpr float kOzone[4] = {static_cast<float>(3.472e-25 * kOzoneColumn), static_cast<float>(3.914e-25 * kOzoneColumn),
                             static_cast<float>(1.349e-25 * kOzoneColumn), static_cast<float>(11.03e-27 * kOzoneColumn)};
constexpr float kAerosolAbsorption[4] = {
    static_cast<float>(2.8722e-24 * kAerosolColumn), static_cast<float>(4.6168e-24 * kAerosolColumn),
    static_cast<float>(7.9706e-24 * kAerosolColumn), static_cast<float>(1.3578e-23 * kAerosolColumn)};
constexpr float kAerosolScattering[4] = {
    static_cast<float>(1.5908e-22 * kAerosolColumn), static_cast<float>(1.7711e-22 * kAerosolColumn),
    static_cast<float>(2.0942e-22 * kAerosolColumn), static_cast<float>(2.4033e-22 * kAerosolColumn)};
constexpr float kAerosolScale = 0.73f, kAerosolBackground = static_cast<float>(2e6 / kAerosolColumn);
// CIE XYZ of the four wavelengths.
constexpr float kXyz[4][3] = {{53.386918f, 22.981338f, 0.0f},
                              {43.904844f, 71.347796f, 0.10250687f},
                              {1.6137278f, 18.422961f, 31.742921f},
                              {20.762669f, 2.3614213f, 110.4801f}};

// Scattering and extinction in each wavelength, per kilometre.
template <class F> struct Coefficients { F air[4], aerosols[4], extinction[4]; };
// height: above the ground. densities: relative to the Earth's.
template <class F> LANCER_LANE Coefficients<F> coefficients_at(const F &height, const float (&densities)[3]) {
  // Below a decimetre nothing changes.
  const F log_height = log(max(height, F(1e-4f))), from_layer = log_height - F(3.22261f);
  const F air = F(densities[0]) * exp(F(-0.07771971f) * exp(F(1.16364243f) * log_height));
  const F aerosols = F(densities[1]) * (exp(-height / F(kAerosolScale)) + F(kAerosolBackground));
  const F ozone = F(densities[2]) * exp(F(-5.55555555f) * from_layer * from_layer - log_height);
  Coefficients<F> c;
  for (int i = 0; i < 4; ++i) {
    c.air[i] = F(kAir[i]) * air;
    c.aerosols[i] = F(kAerosolScattering[i]) * aerosols;
    c.extinction[i] = F(kAerosolAbsorption[i]) * aerosols + c.aerosols[i] + F(kOzone[i]) * ozone + c.air[i];
  }
  return c;
}

} // namespace multiple

// Returns the height above a sphere of a place whose squared radius is q more than the sphere's, without a difference of two
// large numbers.
template <class T> LANCER_LANE T height_of(const T &q, double radius) {
  return q / (T(static_cast<float>(radius)) + sqrt(T(static_cast<float>(radius * radius)) + q));
}

} // namespace
} // namespace lancer
