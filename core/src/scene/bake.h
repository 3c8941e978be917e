// The texels of an image whose surface is rendered in place of the camera's view: a bake.
#pragma once

#include "scene/ray.h"

#include <array>
#include <vector>

namespace lancer {

// From where a bake looks at the surface.
enum class BakeView : uint32_t {
  Above = 0,  // along the normal
  Camera = 1, // from the camera's place
  Sky = 2     // not at the surface: from the world's origin towards it
};

// A place on a triangle: the weights of its corners 0 and 1 in the middle of the texel, and their change over the texel along
// the image's rows and columns.
struct Texel {
  uint32_t primitive = kNone; // kNone: the texel shows nothing
  std::array<float, 2> weights{}, dx{}, dy{};
};

struct Bake {
  uint32_t instance = kNone; // index in the geometry; kNone: the instance was left out, and no texel shows anything
  BakeView view = BakeView::Above;
  uint32_t lacks = 0;          // bits of components whose lobes the surface lacks at first sight
  float bare_roughness = 0.0f; // where no lobe counts
  std::vector<Texel> texels;   // by row from the bottom
};

} // namespace lancer
