// What lights are asked for, side by side. Plain numbers: kernels read and write it.
#pragma once

namespace lancer {

inline constexpr int kWays = 16;

// Stretches of rays: from the last scattering along d, up to the distance end.
struct alignas(64) WayBlock {
  double from[3][kWays], d[3][kWays], end[kWays]; // d: of any length
};

// Directions to the environment, and the density with which its map gives them.
struct alignas(64) SkyBlock {
  float u[2][kWays];
  double wi[3][kWays], pdf[kWays]; // wi: unit
};

} // namespace lancer
