// Vertices in lanes: the block of them and the kernels that shade it.
#pragma once

#include "lights/light_choice.h"
#include "lights/light_kernel.h"
#include "simd/kernel_choice.h"

#include <cstddef>
#include <cstdint>

namespace lancer {

struct Light;
struct Material;

inline constexpr int kBlockLanes = kLightLanes;

// Vertices of paths side by side, from the hit to the rays that leave. Plain numbers: kernels read and write it.
struct alignas(64) VertexBlock {
  using Floats = float[kBlockLanes];
  using Doubles = double[kBlockLanes];
  using Words = uint32_t[kBlockLanes];

  // Given: what was met, and how. o, d: of the ray, d of any length; o and t of exact surfaces alone.
  const double *placement[kBlockLanes]; // Instance::to_world and what follows
  Floats corner[3][3], normals[3][3];   // of a triangle's corners, object space; by corner, axis
  Doubles bary[2], d[3], o[3], t;
  Floats terminator; // Instance::terminator
  // Given: what draw() makes the numbers of. All lanes share the dimension.
  Words pixel, reversed_sample, reversed_point[8];
  uint32_t dimension = 0;
  alignas(64) const Material *material[kBlockLanes]; // all of one class
  Floats through;                                    // mean of what passes straight on
  Floats beta[3];

  // surfaces(): both normals outwards, wo unit. In lanes on no shape the place is given.
  Doubles p[3], offset, length; // of d
  Floats ng[3], ns[3], wo[3];
  Floats u[8];
  // Given: how many lights the vertex asks, and how many paths go on from it; light() and scatter() are for one of them each.
  Doubles lights, paths;

  // Given: what the nodes of the material say, four floats of every lane each; kernels keep the lobes of all lanes in `lobes`,
  // which has room for what VertexKernel::lobes_bytes says.
  const float (*values)[4][kBlockLanes] = nullptr;
  std::byte *lobes = nullptr;
  // lobes(): normals and light on the viewer's side.
  alignas(64) Floats viewer_ns[3], viewer_ng[3];
  Floats emission[3]; // of layers

  // Given: the tree of LightSet::binary_tree(). choose(): one of its lights for each lane, as LightChoice.
  LightNodes light_nodes{};
  alignas(64) Words chosen;
  Doubles chosen_probability, chosen_rest;

  // Given: the lamp to ask, or the sample of another light, with the probability of its choice in pdf either way.
  const Light *lamp[kBlockLanes];
  Doubles light_wi[3], light_target[3], light_pdf;
  Floats light_radiance[3];
  Words light_delta, light_hidden; // bits LANCER_RAY_*

  // light(): the share of paths that pass straight on; what follows is of the others; and what the sample of a light brings.
  // scatter(): where paths go on. Rays start at origin, on the side of their direction. Shadow rays end at light_target, or
  // nowhere.
  Floats pass;
  Floats contribution[3];
  Doubles shadow_origin[3], next_origin[3];
  Floats wi[3], next_beta[3]; // of the next ray
  Doubles pdf;
  Floats alpha2;            // of the lobe that drew it, 0 of a single direction
  Floats share[2][3];       // of the sample's weight that is diffuse, glossy, where shares are wanted
  Floats light_share[2][3]; // the same of the contribution
  // Where occlusion is asked for: a direction around matt_normal by the cosine, and the cosine's density at wi over that of wi.
  Floats occlusion_wi[3], occlusion_weight;

  // Given: what passes ask of the lobes. describe(): what these say.
  uint32_t wants_normal = 0, wants_matt_normal = 0, wants_shown = 0, wants_mixture = 0;
  alignas(64) Floats transmittance[3]; // given
  Floats normal[3], matt_normal[3];    // means of the lobes' normals, of all and of the diffuse ones
  Floats shown[3][3];                  // colours of the passes, by component
  Floats mixed_matt, mixed_all, mixed_diffuse[3], mixed_specular[3], mixed_normal[3]; // Mixture of lobe_means.h

  // ClassicKernel::branch(): shares of light that are mirrored, towards wi, and that go through, towards through_wi.
  // illuminate(): irradiance at normal incidence; contribution is without what it takes to get there.
  Floats reflected[3], refracted[3], through_wi[3], irradiance[3];

  // Bits of lanes.
  uint32_t used = 0;
  uint32_t on_mesh = 0, smooth = 0; // given: triangles; those with normals of their own
  uint32_t exact = 0;               // given: spheres and those that follow
  uint32_t on_plane = 0, on_cylinder = 0, on_cone = 0;
  uint32_t asked = 0;                 // given: lamp is to be sampled
  uint32_t inside = 0;                // surfaces(): seen from within
  uint32_t transmits = 0;             // lobes(): light may come through
  uint32_t scatters = 0;              // lobes(): into more than single directions
  uint32_t shares_wanted = 0;         // given, 1: share and light_share
  uint32_t blended = 0;               // given, 1: Mixture by the rule of Blender 5.2
  uint32_t holes = 0;                 // given: nothing of the lobes is seen
  uint32_t ends = 0;                  // given: nothing is scattered any more
  uint32_t lit = 0;                   // contribution is not black
  uint32_t lifted = 0;                // the shadow ray may have to start on the curved surface
  uint32_t sampled = 0;               // there is a next direction
  uint32_t diffuse = 0;               // drawn by a diffuse lobe
  uint32_t transmitted = 0;           // it goes through the surface
  uint32_t occlusion_asked = 0;       // given: ambient occlusion is to be looked for
  uint32_t next_rays_look = 0;        // given, 1: next rays may look for it
  uint32_t looks_by_next = 0;         // the next ray does, with occlusion_weight
  uint32_t looks_itself = 0;          // a ray towards occlusion_wi is needed
  uint32_t mirrors = 0, refracts = 0; // branch(): wi, through_wi is on the side where it belongs
  uint32_t there = 0;                 // illuminate(): there is a sample
};

// Shading of path vertices in lanes: the surface, its lobes, the choice of a light, scattering.
struct VertexKernel {
  // In this order; nodes are asked after the first, other lights than lamps before light(). From draw() on again for each
  // further light or path. wanted: bits of u.
  void (*surfaces)(VertexBlock &block);
  void (*lobes)(VertexBlock &block);
  void (*describe)(VertexBlock &block);
  void (*draw)(VertexBlock &block, uint32_t wanted);
  void (*choose)(VertexBlock &block);
  void (*light)(VertexBlock &block);
  void (*scatter)(VertexBlock &block);
  // Bits of the lanes that may meet the light; no other does.
  uint32_t (*meets)(const SegmentBlock &segments, const Light &light);
  // What they get of it; place: where it stands in the tree.
  void (*meet)(const SegmentBlock &segments, const Light &light, const LightNodes &tree, uint32_t place, MetLight &met);
  size_t lobes_bytes;
};
LANCER_DECLARE_KERNEL(VertexKernel, vertex_kernel)

} // namespace lancer
