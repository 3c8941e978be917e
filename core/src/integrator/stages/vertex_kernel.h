// Vertices in lanes: their block and the kernels that shade it.
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

// Vertices of paths in lanes, from the hit to the rays that leave. Kernels read and write these plain numbers.
struct alignas(64) VertexBlock {
  using Floats = float[kBlockLanes];
  using Doubles = double[kBlockLanes];
  using Words = uint32_t[kBlockLanes];

  // Input: the hit and its ray. o, d: of the ray, d of any length; o and t only for exact surfaces.
  const double *placement[kBlockLanes]; // Instance::to_world and the following members
  Floats corner[3][3], normals[3][3];   // of a triangle's corners, object space; by corner, axis
  Doubles bary[2], d[3], o[3], t;
  Floats terminator; // Instance::terminator
  // Input of draw(), which makes the random numbers u. All lanes share the dimension.
  Words pixel, reversed_sample, reversed_point[8];
  uint32_t dimension = 0;
  alignas(64) const Material *material[kBlockLanes]; // all of one class
  Floats through;                                    // mean of the transmittance
  Floats beta[3];

  // surfaces(): both normals outwards, wo unit. Lanes without a shape bit have these members as input.
  Doubles p[3], offset, length; // of d
  Floats ng[3], ns[3], wo[3];
  Floats u[8];
  // Input: the numbers of lights sampled at the vertex and of paths that leave it; light() and scatter() compute one of each.
  Doubles lights, paths;

  // Input: the values of the material's nodes, four floats for every lane; and storage for the lobes of all lanes, of size
  // VertexKernel::lobes_bytes.
  const float (*values)[4][kBlockLanes] = nullptr;
  std::byte *lobes = nullptr;
  // lobes(): normals and emission on the viewer's side.
  alignas(64) Floats viewer_ns[3], viewer_ng[3];
  Floats emission[3]; // of layers

  // Input: the tree of LightSet::binary_tree(). choose(): one of its lights for each lane, as LightChoice.
  LightNodes light_nodes{};
  alignas(64) Words chosen;
  Doubles chosen_probability, chosen_rest;

  // Input: the lamp to sample, or the sample of another light. light_pdf is the probability of the choice for a lamp, and
  // includes it for other samples.
  const Light *lamp[kBlockLanes];
  Doubles light_wi[3], light_target[3], light_pdf;
  Floats light_radiance[3];
  Words light_delta, light_hidden; // LANCER_RAY_* bits

  // light(): the share of paths that pass straight through (the following members are for the others), and the contribution of
  // the light sample. scatter(): the next rays. Rays start at their origin, on the side of their direction. Shadow rays end at
  // light_target, or at infinity.
  Floats pass;
  Floats contribution[3];
  Doubles shadow_origin[3], next_origin[3];
  Floats wi[3], next_beta[3]; // of the next ray
  Doubles pdf;
  Floats alpha2;            // of the sampled lobe, 0 for a single direction
  Floats share[2][3];       // diffuse and glossy share of the sample's weight, where shares are wanted
  Floats light_share[2][3]; // the same of the contribution
  // Where occlusion is requested: a direction around matt_normal sampled by the cosine, and the cosine's density at wi over the
  // density of wi.
  Floats occlusion_wi[3], occlusion_weight;

  // Input: the means that passes need. describe(): their values.
  uint32_t wants_normal = 0, wants_matt_normal = 0, wants_shown = 0, wants_mixture = 0;
  alignas(64) Floats transmittance[3]; // input
  Floats normal[3], matt_normal[3];    // mean normals of all lobes and of the diffuse ones
  Floats shown[3][3];                  // colours of the passes, by component
  Floats mixed_matt, mixed_all, mixed_diffuse[3], mixed_specular[3], mixed_normal[3]; // Mixture of lobe_means.h

  // ClassicKernel::branch(): shares of light that are mirrored, towards wi, and transmitted, towards through_wi. illuminate():
  // irradiance at normal incidence; contribution is without the branch's weight.
  Floats reflected[3], refracted[3], through_wi[3], irradiance[3];

  // Each of the following is one bit per lane.
  uint32_t used = 0;
  uint32_t on_mesh = 0, smooth = 0; // input: triangles; those with smooth normals
  uint32_t exact = 0;               // input: spheres and the following shapes
  uint32_t on_plane = 0, on_cylinder = 0, on_cone = 0;
  uint32_t asked = 0;                 // input: lamp is to be sampled
  uint32_t inside = 0;                // lobes(): seen from within
  uint32_t transmits = 0;             // lobes(): the surface transmits light
  uint32_t scatters = 0;              // lobes(): the surface scatters into more than single directions
  uint32_t shares_wanted = 0;         // input, 1: share and light_share
  uint32_t blended = 0;               // input, 1: Mixture by the rule of Blender 5.2
  uint32_t holes = 0;                 // input: lobes are hidden by a hole
  uint32_t ends = 0;                  // input: the path ends here
  uint32_t lit = 0;                   // contribution is not black
  uint32_t lifted = 0;                // the shadow ray may have to start on the curved surface
  uint32_t sampled = 0;               // there is a next direction
  uint32_t diffuse = 0;               // sampled from a diffuse lobe
  uint32_t transmitted = 0;           // the next ray passes through the surface
  uint32_t occlusion_asked = 0;       // input: ambient occlusion is requested
  uint32_t next_rays_look = 0;        // input, 1: next rays may replace occlusion rays
  uint32_t looks_by_next = 0;         // the next ray replaces the occlusion ray, with occlusion_weight
  uint32_t looks_itself = 0;          // a ray towards occlusion_wi is needed
  uint32_t mirrors = 0, refracts = 0; // branch(): wi, through_wi is on its proper side of the surface
  uint32_t there = 0;                 // illuminate(): there is a sample
};

// Shading of path vertices in lanes: the surface, its lobes, the choice of a light, scattering.
struct VertexKernel {
  // Call in this order; run nodes after surfaces(), and sample lights other than lamps before light(). Repeat from draw() for
  // each further light or path. wanted: bits of u.
  void (*surfaces)(VertexBlock &block);
  void (*lobes)(VertexBlock &block);
  void (*describe)(VertexBlock &block);
  void (*draw)(VertexBlock &block, uint32_t wanted);
  void (*choose)(VertexBlock &block);
  void (*light)(VertexBlock &block);
  void (*scatter)(VertexBlock &block);
  // Returns the bits of the lanes that may hit the light; other lanes miss it.
  uint32_t (*meets)(const SegmentBlock &segments, const Light &light);
  // Computes the light that lanes get when they hit it; place: of the light in the tree.
  void (*meet)(const SegmentBlock &segments, const Light &light, const LightNodes &tree, uint32_t place, MetLight &met);
  size_t lobes_bytes;
};
LANCER_DECLARE_KERNEL(VertexKernel, vertex_kernel)

} // namespace lancer
