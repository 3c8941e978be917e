// Stretches of rays side by side: from the last scattering along d, up to the distance end. Plain numbers: kernels read them.
#pragma once

namespace lancer {

inline constexpr int kWays = 16;

struct alignas(64) WayBlock {
  double from[3][kWays], d[3][kWays], end[kWays]; // d: of any length
};

} // namespace lancer
