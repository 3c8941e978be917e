// The nodes of the tree of many lights, and who walks down it. Plain numbers: kernels read and write them.
#pragma once

#include <cstdint>

namespace lancer {

inline constexpr uint32_t kBranchWidth = 16;

// Children side by side: boxes of lights, as ClusterShape. Nothing else is read where all of them shine to all sides.
struct alignas(64) LightBranch {
  // What child says besides a number.
  static constexpr uint32_t kLight = 1u << 31; // the number is that of a light, not of a branch
  static constexpr uint32_t kMet = 1u << 30;   // a ray may run into one of its lights
  static constexpr uint32_t kAimed = 1u << 29; // it does not shine to all sides alike
  static constexpr uint32_t kNumber = kAimed - 1;

  float centre[3][kBranchWidth] = {}, half[3][kBranchWidth] = {};
  float radius[kBranchWidth] = {};    // of the ball around the box
  float per_near2[kBranchWidth] = {}; // 1 / the least squared distance that counts
  float energy[kBranchWidth] = {};    // 0: no child
  uint32_t child[kBranchWidth] = {};
};

// Where the children shine: ShineCone.
struct alignas(64) LightAim {
  float axis[3][kBranchWidth] = {};
  float cos_o[kBranchWidth] = {}, sin_o[kBranchWidth] = {}, cos_all[kBranchWidth] = {};
};

struct LightBranches {
  static constexpr uint32_t kRoot = 0xffffffffu; // slot of the root
  // From some level on, branches have lights in even numbers: eight levels more hold all that can be counted.
  static constexpr int kDeepest = 32, kEvenFrom = kDeepest / 2;

  const LightBranch *branches = nullptr; // 0 is the root
  const LightAim *aims = nullptr;        // of each; null where no child is aimed
  // Of each branch in its parent: kBranchWidth times that one's number, and the child's.
  const uint32_t *slot_of = nullptr;
};

// A LightQuery, and a LightChoice that comes of it.
struct LightWalk {
  float p[3] = {}, n[3] = {};
  float slack = 0.0f;
  bool transmits = false;
  uint32_t number = 0;
  double u = 0.0, probability = 0.0;
};

} // namespace lancer
