// The tree of many lights as kernels read it, and the walks down the tree. All records are plain numbers.
#pragma once

#include "sampling/direction_table.h"
#include "simd/kernel_choice.h"

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

// Records of light sampling in lanes. Kernels read and write these plain numbers.
inline constexpr int kLightLanes = 16;

// Segments of rays: from the last scattering along d, up to the distance end. normal and transmits are those of the LightQuery
// at that scattering.
struct alignas(64) SegmentBlock {
  double from[3][kLightLanes], d[3][kLightLanes], end[kLightLanes]; // d: of any length
  float normal[3][kLightLanes];
  uint32_t transmits; // bits of lanes
};

// LightHit of each lane, and the probability with which the last scattering chose the light.
struct alignas(64) MetLight {
  double pdf[kLightLanes], distance[kLightLanes], chosen[kLightLanes];
  float radiance[3][kLightLanes];
};

// Directions to the environment, and the density with which its map gives them.
struct alignas(64) SkyBlock {
  float u[2][kLightLanes];
  double wi[3][kLightLanes], pdf[kLightLanes]; // wi: unit
};

// One face of an emitting mesh for each lane, and the sample that a point takes of it.
struct alignas(64) FaceBlock {
  // Input: the mesh's placement as Instance::placement(); the face's corners in object space; the shaded point; two random
  // numbers.
  const double *placement[kLightLanes];
  float corner[3][3][kLightLanes]; // by corner, axis
  double p[3][kLightLanes];
  float u[2][kLightLanes];
  uint32_t used = 0; // bits of lanes
  // The sample, as LightSample, and its weights of corners 1 and 2.
  alignas(64) double wi[3][kLightLanes], target[3][kLightLanes], pdf[kLightLanes], weights[2][kLightLanes];
  // The face's normal, outwards.
  float ng[3][kLightLanes];
};

// Kernels of light sampling, one copy per instruction set; all copies give the same bits.
struct LightKernel {
  const char *name;
  // Chooses a light for each walk: reads u as the random number and writes the rest of it back.
  void (*choose)(const LightBranches &tree, LightWalk *walks, uint32_t count);
  // Returns the probability with which choose() reaches the child in that slot. Does not read number, u and probability of the
  // walk.
  double (*probability)(const LightBranches &tree, const LightWalk &walk, uint32_t slot);
  // Calls visit(context, lane, light) for all lights that the first count segments may hit; no other light can be hit.
  using Visit = void (*)(void *context, uint32_t lane, uint32_t light);
  void (*along)(const LightBranches &tree, const SegmentBlock &segments, uint32_t count, Visit visit, void *context);
  // sample_sky samples directions of the environment from the numbers u; sky_density computes the density of given directions.
  void (*sample_sky)(const DirectionTable &map, SkyBlock &block);
  void (*sky_density)(const DirectionTable &map, SkyBlock &block);
  // Samples a point of each face, as Emitter::sample_face().
  void (*sample_faces)(FaceBlock &block);
};

// Each copy is light_kernel.cpp compiled with LANCER_ISA set to its name.
LANCER_DECLARE_KERNEL(LightKernel, light_kernel)

} // namespace lancer
