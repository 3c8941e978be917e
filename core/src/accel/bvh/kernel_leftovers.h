// What is left over of rays that went together, for each to do alone.
// Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/kernel_enter.h"
#include "accel/bvh/kernel_slot.h"

namespace lancer {
namespace {

constexpr uint32_t kFew = 2;       // lanes that are better off alone
constexpr uint32_t kLeftovers = 8; // of a lane

// What each lane has still to visit, and its best hit so far.
struct Leftovers {
  Hit best[kPacket];
  alignas(64) double best_t[kPacket];
  uint32_t count[kPacket];
  float entries[kPacket][kLeftovers];
  uint32_t children[kPacket][kLeftovers];
};

// Leaves work for each of some lanes to do alone; false where one has no room.
LANCER_SIMD bool leave_over(uint32_t child, uint32_t lanes, const float *entry, Leftovers &l) {
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1)
    if (l.count[__builtin_ctz(rest)] == kLeftovers)
      return false;
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const int lane = __builtin_ctz(rest);
    const uint32_t i = l.count[lane]++;
    l.entries[lane][i] = entry ? entry[lane] : -__builtin_inff();
    l.children[lane][i] = child;
  }
  return true;
}

// Goes on alone with what is left of a lane, the nearest on top.
LANCER_SIMD void resume(const Leftovers &l, uint32_t lane, Slot &s) {
  s.best = l.best[lane];
  s.unbounded = 0;
  s.size = 1;
  for (uint32_t i = l.count[lane]; i-- > 0;)
    push(s, l.entries[lane][i], l.children[lane][i]);
}

} // namespace
} // namespace lancer
