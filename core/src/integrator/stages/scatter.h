// The next directions of paths, in lanes, sampled from the lobes of surfaces.
//
// In: surfaces, their lobes, numbers and throughputs, from an integrator. Out: ScatterBlock, for the occlusion stage and the
// integrator. Densities are per solid angle; the block is for paths that are scattered, not for those that pass straight
// through. Caller: PATH.
#pragma once

#include "integrator/stages/numbers.h"
#include "integrator/stages/surface.h"

namespace lancer {

struct alignas(64) ScatterBlock {
  Doubles origin[3]; // of the next ray, on the side of wi
  Doubles pdf;       // of wi among all paths: pdf_scattered (1 - LobeBlock::pass); 0: a single direction
  Floats wi[3], beta[3];
  Floats pdf_scattered; // of wi among scattered paths, 0: a single direction
  Floats alpha2;        // alpha_x alpha_y of the sampled lobe, 0 for a single direction
  Floats mean_alpha2;   // see BsdfSample, where LobeBlock::spreads is set
  Floats share[2][3];   // diffuse and glossy share of the sample's weight, where shares are wanted
  // Parameters of walks below the surface, in lanes that enter it: see BsdfSample.
  Floats below_color[3], below_radius[3], below_g, below_ior;
  Words below_variant;
  // Each of the following is one bit per lane.
  uint32_t sampled = 0;     // there is a next direction
  uint32_t diffuse = 0;     // the next ray is a diffuse one, as BsdfSample::diffuse says
  uint32_t transmitted = 0; // the next ray passes through the surface
  uint32_t entered = 0;     // the path enters the surface, to walk below it
};

// The vertices that scatter. beta: throughput from the vertex to the camera; count: number of paths that leave the vertex.
struct ScatteringVertices {
  const SurfaceBlock &surfaces;
  const LobeBlock &lobes;
  const VertexNumbers &numbers;
  const Floats (&beta)[3];
  const Doubles &count;
};

struct ScatterKernel {
  void (*scatter)(const ScatteringVertices &vertices, ScatterBlock &next);
};
LANCER_DECLARE_KERNEL(ScatterKernel, scatter_kernel)

class ScatterStage {
public:
  ScatterStage() : kernel_(scatter_kernel()) {}

  // Samples the next direction of each vertex.
  void scatter(const ScatteringVertices &vertices) { kernel_.scatter(vertices, next_); }
  // Decides by Russian roulette whether a path goes on. scatterings: of the path, with this one; u: in [0, 1); sharers: number
  // of paths that share its weight. beta: divided by the probability of survival.
  static bool survives(uint32_t scatterings, float u, float sharers, glm::vec3 &beta);
  // Writes the next ray of a lane in place.
  void write_ray(uint32_t lane, const Hit &hit, uint32_t kinds, float time, Ray &ray) const;
  // Returns the RayKind bit of a lane's next ray.
  uint32_t kind(uint32_t lane) const;

  const ScatterBlock &next() const { return next_; }

private:
  const ScatterKernel &kernel_;
  ScatterBlock next_{};
};

} // namespace lancer
