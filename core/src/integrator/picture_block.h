// What many paths ask of pictures, side by side. Plain numbers: kernels read and write it.
#pragma once

#include "integrator/vertex_block.h"

namespace lancer {

// Directions that meet nothing.
struct alignas(64) SkyBlock {
  VertexBlock::Doubles wi[3], pdf; // given: unit; as of Environment
  VertexBlock::Floats radiance[3]; // where there is a picture
};

// Places on surfaces.
struct alignas(64) ColorBlock {
  VertexBlock::Floats uv[2], color[3], alpha;
};

} // namespace lancer
