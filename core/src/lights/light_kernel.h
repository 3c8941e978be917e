// The tree of many lights as kernels read it, and who walks down it. Plain numbers.
#pragma once

#include "sampling/direction_table.h"
#include "simd/kernel_choice.h"

#include <cstdint>

namespace lancer {

// The nodes of the tree of many lights, and who walks down it. Plain numbers: kernels read and write them.
inline constexpr uint32_t kBranchWidth = 16;

// Children side by side: boxes of lights, as ClusterShape. Nothing else is read where all of them shine to all sides.
struct alignas(64) LightBranch {
  // What child says besides a number.
  static constexpr uint32_t kLight = 1u << 31;    // the number is that of a light, not of a branch
  static constexpr uint32_t kMayBeHit = 1u << 30; // a ray may run into one of its lights
  static constexpr uint32_t kAimed = 1u << 29;    // it does not shine to all sides alike
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

// What lights are asked for, side by side. Plain numbers: kernels read and write it.
inline constexpr int kLightLanes = 16;

// Stretches of rays: from the last scattering along d, up to the distance end. And how that asked for light, as LightQuery.
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

// Faces of glowing meshes, one for each lane, and what a point gets of them.
struct alignas(64) FaceBlock {
  // Given: where the mesh is placed, Instance::placement(); the face's corners in object space; who sees it; two numbers.
  const double *placement[kLightLanes];
  float corner[3][3][kLightLanes]; // by corner, axis
  double p[3][kLightLanes];
  float u[2][kLightLanes];
  uint32_t used = 0; // bits of lanes
  // The sample: as LightSample; and its weights of corners 1 and 2.
  alignas(64) double wi[3][kLightLanes], target[3][kLightLanes], pdf[kLightLanes], weights[2][kLightLanes];
  // The face's normal, outwards.
  float ng[3][kLightLanes];
};

// Choosing of many lights and finding those on a ray's way in vector registers, one copy per instruction set; all give the same
// bits.
struct LightKernel {
  const char *name;
  // A light for each: u is the number to choose by, then what is left of it.
  void (*choose)(const LightBranches &tree, LightWalk *walks, uint32_t count);
  // With which choose() comes to the child in that slot; number, u, probability of the walk are not read.
  double (*probability)(const LightBranches &tree, const LightWalk &walk, uint32_t slot);
  // Calls visit(context, lane, light) for all that the first count ways may meet; no other light is met.
  using Visit = void (*)(void *context, uint32_t lane, uint32_t light);
  void (*along)(const LightBranches &tree, const SegmentBlock &segments, uint32_t count, Visit visit, void *context);
  // Samples directions of the environment from the numbers u; asks for the density of those given.
  void (*sample_sky)(const DirectionTable &map, SkyBlock &block);
  void (*sky_density)(const DirectionTable &map, SkyBlock &block);
  // Samples a point of each face, as Emitter::sample_face().
  void (*sample_faces)(FaceBlock &block);
};

// Each is the same source, light_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(LightKernel, light_kernel)

} // namespace lancer
