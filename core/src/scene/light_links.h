// Light linking: which receivers a light reaches, and which blockers it passes.
#pragma once

#include <cstdint>

namespace lancer {

// Numbers of sets are below this one.
inline constexpr uint32_t kLinkSets = 64;

// Sets as bits; see lancer_instance.
struct LightLinks {
  uint64_t unlit_sets = 0, clear_sets = 0;

  bool reaches(uint32_t receiver_set) const { return !(unlit_sets >> receiver_set & 1); }
  bool passes(uint32_t blocker_set) const { return clear_sets >> blocker_set & 1; }
  bool operator==(const LightLinks &) const = default;
};

} // namespace lancer
