// Places at two moments, one animation frame before the picture and one after, for the pass Vector. No ray is traced at these
// places.
#pragma once

#include "scene/affine.h"
#include "scene/camera.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lancer {

// The moments, in this order.
inline constexpr uint32_t kMoments = 2;

// The placements of an instance.
using MomentPlaces = std::array<Affine, kMoments>;

// An instance that moves, by its Instance::number.
struct GivenVectors {
  uint32_t instance = 0;
  MomentPlaces to_world;
};

// The instances of a scene that move, in the normalised world.
struct InstanceVectors {
  std::vector<MomentPlaces> places;
  std::vector<uint32_t> of_instance; // by instance: the number of its places, or kNone; empty where none moves

  // Returns the places of an instance, or null if it stands still.
  const MomentPlaces *find(uint32_t instance) const {
    return of_instance.empty() || of_instance[instance] == kNone ? nullptr : &places[of_instance[instance]];
  }
  size_t bytes() const { return places.size() * sizeof(MomentPlaces) + of_instance.size() * sizeof(uint32_t); }
};

// A camera at the moments.
struct CameraMoments {
  std::array<Camera, kMoments> cameras;
  bool moves = false;
};

} // namespace lancer
