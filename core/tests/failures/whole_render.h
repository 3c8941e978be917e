// A render through the C interface from the first call to the last, with a bit of everything.
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
// All passes of the picture in sequence.
inline constexpr size_t kWholeFloats = size_t(kWholeSide) * kWholeSide * 80;

// The first call that failed, if any; after it only destroying calls were made.
struct RenderOutcome {
  const char *call = nullptr;
  lancer_status status = LANCER_OK;
  char message[256] = "";

  bool whole() const { return call == nullptr; }
};

// Makes the input of render_whole(), which allocates memory, once.
void prepare_whole();

// Renders meshes with attributes, materials of nodes, images, enough lamps for a tree and a sky that varies, reads all passes
// into picture [kWholeFloats], requests the error, statistics, a replay and probes, and frees everything. Does not allocate
// memory itself.
RenderOutcome render_whole(const RenderKind &kind, std::span<float> picture);

} // namespace lancer_test
