// Vertices of paths side by side, from the hit to the rays that leave. Plain numbers: kernels read and write it.
#pragma once

#include "bsdf/wide_lobe.h"
#include "lights/light_choice.h"
#include "lights/way_block.h"

#include <cstdint>

namespace lancer {

struct Light;

inline constexpr int kBlockLanes = kWays;

struct alignas(64) VertexBlock {
  using Floats = float[kBlockLanes];
  using Doubles = double[kBlockLanes];
  using Words = uint32_t[kBlockLanes];

  // Given: triangles, spheres and planes, and how they were met. o, d: of the ray, d of any length; o and t of spheres and
  // planes alone.
  const double *placement[kBlockLanes]; // Instance::to_world and what follows
  Floats corner[3][3], normal[3][3];    // of a triangle's corners, object space; by corner, axis
  Doubles bary[2], d[3], o[3], t;
  Floats terminator; // Instance::terminator
  // Given: what the sampler makes its numbers of. All lanes share the sample and its dimension.
  Words pixel;
  uint32_t dimension = 0, reversed_sample = 0, reversed_point[8] = {};
  uint32_t numbers_given = 0; // 1: u is given instead
  alignas(64) const WideMaterial *material[kBlockLanes];
  Floats weight[3], base[3]; // of WideMaterial
  Floats through;            // mean of what passes straight on
  Floats beta[3];

  // surfaces(): both normals outwards, wo unit. Lanes of other shapes are filled in by hand.
  Doubles p[3], offset, length; // of d
  Floats ng[3], ns[3], wo[3];
  Floats u[8];

  // Given: the tree of LightSet::few(). choose(): one of its lights for each lane, as LightChoice.
  LightNodes light_nodes{};
  alignas(64) Words chosen;
  Doubles chosen_probability, chosen_rest;

  // Given: the lamp to ask, or the sample of another light, with the probability of its choice in pdf either way.
  const Light *lamp[kBlockLanes];
  Doubles light_wi[3], light_target[3], light_pdf;
  Floats light_radiance[3];
  Words light_delta, light_hidden; // bits LANCER_RAY_*

  // shade(): the share of paths that pass straight on; what follows is of the others. Rays start at origin, on the side of
  // their direction. Shadow rays end at light_target, or nowhere.
  Floats pass;
  Floats contribution[3];
  Doubles shadow_origin[3], next_origin[3];
  Floats viewer_ns[3], viewer_ng[3];
  Floats wi[3]; // beta then is that of the next ray
  Doubles pdf;

  // Bits of lanes.
  uint32_t used = 0;
  uint32_t on_mesh = 0, smooth = 0;     // given: triangles; those with normals of their own
  uint32_t on_sphere = 0, on_plane = 0; // given
  uint32_t asked = 0;                   // given: lamp is to be sampled
  uint32_t transmits = 0;               // given: light is asked for as where light may come through
  uint32_t ends = 0;                    // given: nothing is scattered any more
  uint32_t odd = 0;                     // only the general code can do them: nothing else holds
  uint32_t lit = 0;                     // contribution is not black
  uint32_t lifted = 0;                  // the shadow ray may have to start on the curved surface
  uint32_t sampled = 0;                 // there is a next direction
  uint32_t glossy = 0;                  // drawn by a glossy lobe
  uint32_t transmitted = 0;             // it goes through the surface; glossy says nothing then
};

} // namespace lancer
