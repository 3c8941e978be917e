// The tree of many lights as kernels read it, and the walks down the tree. All records are plain numbers.
#pragma once

#include "simd/block.h"
#include "simd/processor.h"

#include <cstdint>

namespace lancer {

// Number of children of a branch.
inline constexpr uint32_t kBranchWidth = 16;

// The boxes of a branch's children in lanes, as ClusterShape. Nothing else is read where all children shine in all directions.
struct alignas(64) LightBranch {
  // Bits of a child's word beside its number.
  static constexpr uint32_t kLight = 1u << 31;    // the number is that of a light, not of a branch
  static constexpr uint32_t kMayBeHit = 1u << 30; // a ray may hit one of its lights
  static constexpr uint32_t kAimed = 1u << 29;    // it does not shine equally in all directions
  static constexpr uint32_t kNumber = kAimed - 1;

  float centre[3][kBranchWidth] = {}, half[3][kBranchWidth] = {};
  float radius[kBranchWidth] = {};    // of the ball around the box
  float per_near2[kBranchWidth] = {}; // 1 / the smallest squared distance that is used
  float energy[kBranchWidth] = {};    // 0: no child
  uint32_t child[kBranchWidth] = {};
};

// The directions into which the children shine, as ShineCone.
struct alignas(64) LightAim {
  float axis[3][kBranchWidth] = {};
  float cos_o[kBranchWidth] = {}, sin_o[kBranchWidth] = {}, cos_all[kBranchWidth] = {};
};

struct LightBranches {
  static constexpr uint32_t kRoot = 0xffffffffu; // slot of the root
  // Below level kEvenFrom, branches have equal numbers of lights in their children: eight more levels hold all numbers that can
  // be counted.
  static constexpr int kDeepest = 32, kEvenFrom = kDeepest / 2;

  const LightBranch *branches = nullptr; // 0 is the root
  const LightAim *aims = nullptr;        // of each branch; null if no child of any branch is aimed
  // The slot of each branch in its parent: kBranchWidth times the parent's number, plus the child's.
  const uint32_t *slot_of = nullptr;
};

// A LightQuery, and the LightChoice that results from it.
struct LightWalk {
  float p[3] = {}, n[3] = {};
  float slack = 0.0f;
  bool transmits = false;
  uint32_t number = 0;
  double u = 0.0, probability = 0.0;
};

// Segments of rays, by the stage of met lights: from the last scattering along d, up to the distance end. normal and transmits
// are those of the LightQuery at that scattering.
struct alignas(64) SegmentBlock {
  Doubles from[3], d[3], end; // d: of any length
  Floats normal[3];
  uint32_t transmits; // bits of lanes
};

// Receives the lights that segments may hit.
class LightVisitor {
public:
  virtual void visit(uint32_t lane, uint32_t light) = 0;

protected:
  ~LightVisitor() = default;
};

// One copy per instruction set; all copies give the same bits.
struct TreeKernel {
  const char *name;
  // Chooses a light for each walk: reads u as the random number and writes the rest of it back.
  void (*choose)(const LightBranches &tree, LightWalk *walks, uint32_t count);
  // Returns the probability with which choose() reaches the child in that slot. Does not read number, u and probability of the
  // walk.
  double (*probability)(const LightBranches &tree, const LightWalk &walk, uint32_t slot);
  // Hands all lights that the first count segments may hit to the visitor; no other light can be hit.
  void (*along)(const LightBranches &tree, const SegmentBlock &segments, uint32_t count, LightVisitor &visitor);
};

// Each copy is tree_kernel.cpp compiled with LANCER_ISA set to its name.
LANCER_DECLARE_KERNEL(TreeKernel, tree_kernel)

} // namespace lancer
