// Shading of the recursive ray tracer in lanes, for surfaces whose lobes the surface stage has built.
#pragma once

#include "integrator/stages/light.h"

namespace lancer {

// Shares of light that are mirrored and transmitted, and their directions.
struct alignas(64) BranchBlock {
  Floats reflected[3], refracted[3], mirrored[3], through[3];
  uint32_t mirrors = 0, refracts = 0; // bits of lanes: the direction is on its proper side of the surface
};

// One lamp's irradiance at normal incidence.
struct alignas(64) IrradianceBlock {
  Floats irradiance[3];
  uint32_t there = 0; // bits of lanes that have a sample
};

struct ClassicKernel {
  // Computes the mirrored and the transmitted share and their directions.
  void (*branch)(const LobeBlock &lobes, BranchBlock &branches);
  // Computes the light of samples of one light without occlusion, and without the branch's weight. hidden_from: RayKind
  // bits of the rays that do not see the light.
  void (*illuminate)(const SurfaceBlock &surfaces, const LobeBlock &lobes, const LightSamples &samples,
                     const ClassicLight &light, uint32_t hidden_from, LitBlock &lit, IrradianceBlock &irradiance);
  // Computes the members of LitBlock that shadow rays need, for samples on the viewer's side of the surface.
  void (*aim)(const SurfaceBlock &surfaces, const LobeBlock &lobes, const LightSamples &samples, LitBlock &lit);
};
LANCER_DECLARE_KERNEL(ClassicKernel, classic_kernel)

} // namespace lancer
