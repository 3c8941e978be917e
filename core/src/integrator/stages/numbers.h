// The random numbers of a sample by name, and those of vertices in lanes, also where samples split.
//
// In: the address of each lane's sample and the dimension of its vertex, from an integrator. Out: VertexNumbers, in [0, 1), for
// the stages light, scatter and occlusion, and for roulette. Callers: PATH; CLASSIC sets numbers of its own. The camera's and
// the crossings' dimensions also stand here.
#pragma once

#include "sampling/sobol.h"
#include "simd/block.h"
#include "simd/processor.h"

namespace lancer {

// Dimensions of the sampler: the camera's, then eight per vertex of a path.
enum Dimension : uint32_t { kDimensionPixel = 0, kDimensionLens = 2, kDimensionVertex = 4 };
enum VertexDimension : uint32_t {
  kVertexBsdf = 0,
  kVertexLight = 2,
  kVertexLightChoice = 4,
  kVertexLobe = 5,
  kVertexRoulette = 6,
  kVertexLightDigits = 7, // more digits of the choice, which a million faces need
  kVertexStride = 8
};
// The decisions at crossings have dimensions of their own, far behind the others; light samples there share those of the next
// vertex.
inline constexpr uint32_t kDimensionOpacity = 1u << 16;
// The time of a sample. Through a pinhole it takes a number of the lens, which is one sequence with those of pixel and
// vertices.
inline constexpr uint32_t kDimensionTime = 1u << 29;
// The rays of nodes have dimensions of their own by scatterings and crossings, in the order of those of opacity.
inline constexpr uint32_t kDimensionNodes = 1u << 30;
// One more than the largest number of surfaces that a path may pass straight through.
inline constexpr uint32_t kMaxCrossings = 1025;

// Sets of a vertex's numbers, as bits: those of a light sample, and those of the next ray.
inline constexpr uint32_t kLightNumbers = 3u << kVertexLight | 1u << kVertexLightChoice | 1u << kVertexLightDigits;
inline constexpr uint32_t kPathNumbers = 3u << kVertexBsdf | 1u << kVertexLobe | 1u << kVertexRoulette;

// The numbers of a vertex, indexed by VertexDimension.
struct alignas(64) VertexNumbers {
  Floats of[kVertexStride];
};

// The digits of the samples from which the kernel draws. All lanes share the dimension.
struct alignas(64) SampleDigits {
  Words pixel, reversed_sample, reversed_point[kVertexStride];
  uint32_t dimension = 0;
};

struct NumberKernel {
  // Draws the wanted numbers in the first count lanes.
  void (*draw)(const SampleDigits &digits, uint32_t wanted, uint32_t count, VertexNumbers &numbers);
};
LANCER_DECLARE_KERNEL(NumberKernel, number_kernel)

class NumberStage {
public:
  NumberStage() : kernel_(number_kernel()) {}

  // Sets the sample of a lane and the first dimension of its vertex. The lanes of a block are set in turn, from lane 0 on.
  void set(uint32_t lane, const Sampler &sampler, uint32_t dimension) {
    digits_.pixel[lane] = sampler.pixel();
    sample_[lane] = sampler.sample();
    dimension_[lane] = dimension;
    same_ = lane == 0 || (same_ && dimension == dimension_[0]);
  }
  // Draws the wanted numbers, bits of VertexDimension, in the first count lanes. In the lanes of splitting, light or path
  // `branch` of `branches` takes the numbers of the sample branches * s + branch, where s is the number of the lane's sample.
  // Together, the branches are then distributed as evenly as the samples of an unsplit sequence.
  void draw(uint32_t wanted, uint32_t count, uint32_t splitting = 0, uint32_t branches = 1, uint32_t branch = 0);

  VertexNumbers numbers{}; // kernels also look up tables by the numbers of lanes without a sample

private:
  const NumberKernel &kernel_;
  SampleDigits digits_{};
  Words sample_{}, dimension_{};
  bool same_ = true; // all lanes have the same dimension
};

} // namespace lancer
