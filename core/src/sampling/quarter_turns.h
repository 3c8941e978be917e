// An angle of any size by quarters of a turn.
#pragma once

#include <cstdint>

namespace lancer {

// x = (quarters + 4 n) pi / 2 + high + low, |high| <= pi / 4 but for rounding, and low the part of it that high has no room
// for: together within 2^-60 of them, relatively. x is finite.
struct QuarterTurns {
  uint32_t quarters = 0; // 0 ... 3
  double high = 0.0, low = 0.0;
};
QuarterTurns quarter_turns(double x);

} // namespace lancer
