// Up to 16 hits at which one program of nodes runs in lanes. Plain numbers, read and written by kernels.
#pragma once

#include "nodes/light_path.h"
#include "simd/block.h"

#include <cstdint>
#include <glm/glm.hpp>

namespace lancer {

struct Camera;
struct GeometryView;
struct Instance;
struct Normalisation;
struct NodeRays;

// Scene data that any node may read.
struct NodeScene {
  const GeometryView *geometry = nullptr;       // null: no instances
  const Normalisation *normalisation = nullptr; // null: the user's world is the normalised one
  const Camera *camera = nullptr;               // null: CAMERA and WINDOW use the world's frame
};

// From where nodes of a block that look around send rays (looking.h). Bits of lanes: used, and sharp: rays that have arrived by
// no wide lobe, on which Cycles bevels.
struct alignas(64) LookingLanes {
  const NodeRays *rays = nullptr;
  uint32_t used = 0, sharp = 0;
  alignas(64) double offset[kBlockLanes];                                   // Surface::offset
  uint32_t pixel[kBlockLanes], sample[kBlockLanes], dimension[kBlockLanes]; // of random numbers
};

// The time of each lane's ray, and its instance as it is placed then; null: as it stands.
struct MovedLanes {
  const Instance *instance[kBlockLanes] = {};
  float time[kBlockLanes] = {};
};

// The inputs of nodes in lanes. The caller sets the used lanes of every array that the kind of place needs; other lanes are not
// read as input.
//
// Data that only LIGHT_PATH and images with mipmaps read may be missing. On a surface, the caller sets all arrays except eye:
// ns and ng are unit, on the viewer's side; backfacing marks lanes where the surface's own normals are on the other side. For
// directions of the world (surface is false), the caller sets p (the direction), ns = ng = wo = -p, and eye.
struct alignas(64) NodeBlock {
  NodeScene scene;
  const LookingLanes *looking = nullptr; // null: nodes that look around meet nothing
  const MovedLanes *moved = nullptr;     // null: everything stands still
  bool surface = true;
  uint32_t used = 0, backfacing = 0; // bits of lanes

  alignas(64) uint32_t instance[kBlockLanes], primitive[kBlockLanes];
  double bary[2][kBlockLanes]; // weights of vertices 1 and 2; 0 on exact surfaces
  double p[3][kBlockLanes];    // normalised world
  float ns[3][kBlockLanes], ng[3][kBlockLanes], wo[3][kBlockLanes];
  float footprint[kBlockLanes];       // radius of the pixel's footprint, normalised units; 0: no bumps
  const glm::dvec3 *eye[kBlockLanes]; // origin of a camera ray; null: any other ray
  // The members of LightPath.
  uint32_t kinds[kBlockLanes];
  float length[kBlockLanes], depth[kBlockLanes], diffuse[kBlockLanes], glossy[kBlockLanes], transmission[kBlockLanes],
      transparent[kBlockLanes], portal[kBlockLanes], width[kBlockLanes], spread[kBlockLanes];
};

inline void put(const LightPath<float> &path, NodeBlock &block, uint32_t lane) {
  block.kinds[lane] = path.kinds;
  block.length[lane] = path.length;
  block.depth[lane] = path.depth;
  block.diffuse[lane] = path.diffuse;
  block.glossy[lane] = path.glossy;
  block.transmission[lane] = path.transmission;
  block.transparent[lane] = path.transparent;
  block.portal[lane] = path.portal;
  block.width[lane] = path.width;
  block.spread[lane] = path.spread;
}

// Results of one node: x, y, z or RGB, and alpha.
struct alignas(64) NodeLanes {
  float of[4][kBlockLanes];
};

} // namespace lancer
