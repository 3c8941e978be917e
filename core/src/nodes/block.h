// Up to 16 places at which one program of nodes runs side by side. Plain numbers: kernels read and write it.
#pragma once

#include "nodes/light_path.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lancer {

struct Camera;
struct Geometry;
struct Image;
struct Normalisation;

// What all nodes may look at.
struct NodeScene {
  const Geometry *geometry = nullptr; // null: nothing is placed
  const std::vector<Image> *images = nullptr;
  const Normalisation *normalisation = nullptr; // null: the user's world is the normalised one
  const Camera *camera = nullptr;               // null: CAMERA and WINDOW see the world's frame
};

inline constexpr int kNodeLanes = 16;

// Fill in the lanes that are used, in all arrays that the kind of place has; the others may hold anything.
//
// What LIGHT_PATH does not ask for need not be there. On surfaces: everything but eye. ns and ng are unit and look to the
// viewer's side; backfacing tells where those of the surface itself look the other way. For directions of the world (surface is
// false): p is the direction, ns = ng = wo = -p, and eye.
struct alignas(64) NodeBlock {
  NodeScene scene;
  bool surface = true;
  uint32_t used = 0, backfacing = 0; // bits of lanes

  alignas(64) uint32_t instance[kNodeLanes], primitive[kNodeLanes];
  double bary[2][kNodeLanes]; // weights of vertex 1 and 2; 0 on exact surfaces
  double p[3][kNodeLanes];    // normalised world
  float ns[3][kNodeLanes], ng[3][kNodeLanes], wo[3][kNodeLanes];
  float footprint[kNodeLanes];       // radius of what a pixel covers, normalised units; 0: no bumps
  const glm::dvec3 *eye[kNodeLanes]; // where a camera's ray starts; null: any other ray
  // As LightPath has them.
  uint32_t kinds[kNodeLanes];
  float length[kNodeLanes], depth[kNodeLanes], diffuse[kNodeLanes], glossy[kNodeLanes], transmission[kNodeLanes],
      transparent[kNodeLanes], portal[kNodeLanes];
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
}

// What one node gave: x, y, z or RGB, and alpha.
struct alignas(64) NodeLanes {
  float of[4][kNodeLanes];
};

} // namespace lancer
