// Shading of path vertices in vector registers, one copy per instruction set; all give the same bits, and those of Bsdf.
#pragma once

#include "bsdf/wide_lobe.h"

#include <cstdint>

namespace lancer {

inline constexpr int kBlockLanes = 16;

// Vertices side by side. Unused lanes repeat the first.
struct alignas(64) VertexBlock {
  using Floats = float[kBlockLanes];
  using Doubles = double[kBlockLanes];
  using Words = uint32_t[kBlockLanes];

  // Directions are of the world and unit; both normals are on the viewer's side.
  Floats wo[3], ns[3], ng[3];
  const WideMaterial *material[kBlockLanes];
  Floats u_lobe, u_bsdf[2];
  Floats beta[3];
  // A light's sample: LightSample with the choice's probability in pdf; pdf 0: none.
  Floats light_wi[3], light_radiance[3];
  Doubles light_pdf;
  Words light_delta, light_hidden; // bits LANCER_RAY_*

  Floats contribution[3];
  Floats wi[3], weight[3], pdf;
  // Bits of lanes.
  uint32_t bent = 0;    // they want another normal: nothing else holds for them
  uint32_t lit = 0;     // contribution is not black
  uint32_t sampled = 0; // there is a next direction
  uint32_t glossy = 0;  // drawn by a glossy lobe
};

struct VertexKernel {
  const char *name;
  void (*shade)(VertexBlock &block);
};

#if defined(__x86_64__)
namespace sse4 {
extern const VertexKernel vertex_kernel;
}
namespace avx2 {
extern const VertexKernel vertex_kernel;
}
namespace avx512 {
extern const VertexKernel vertex_kernel;
}
#else
namespace generic {
extern const VertexKernel vertex_kernel;
}
#endif

// The one that this processor runs, or that LANCER_ISA asks for.
const VertexKernel &vertex_kernel();

} // namespace lancer
