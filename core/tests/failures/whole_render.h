// A render from the first call to the last that has a bit of everything, through the C interface.
#pragma once

#include "lancer.h"

#include <span>
#include <vector>

namespace lancer_test {

struct RenderKind {
  uint32_t integrator = LANCER_PATH;
  uint32_t accelerator = LANCER_BVH;
  uint32_t threads = 2;
  bool refines = false;
};

inline constexpr uint32_t kWholeSide = 8;
// All passes of the picture, one after the other.
inline constexpr size_t kWholeFloats = size_t(kWholeSide) * kWholeSide * 64;

// The first call that went wrong, if any did; after it nothing was called but what ends things.
struct RenderOutcome {
  const char *call = nullptr;
  lancer_status status = LANCER_OK;
  char message[256] = "";

  bool whole() const { return call == nullptr; }
};

// Makes what render_whole describes, which takes memory, once.
void prepare_whole();

// Renders meshes with attributes, materials of nodes, pictures, lamps enough for a tree and a sky that varies, reads all passes
// into picture [kWholeFloats], asks for the error, statistics, a replay and probes, and leaves nothing behind. Asks for no
// memory itself.
RenderOutcome render_whole(const RenderKind &kind, std::span<float> picture);

} // namespace lancer_test
