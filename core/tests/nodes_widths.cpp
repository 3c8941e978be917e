// Textures and curves in the lanes of each instruction set: the bits of one place, whatever the numbers are.
#include "lancer.h"
#include "sampling/elementary.h"
#include "scene/node.h"
#include "widths/each_kernel.h"
#include "widths/texture_kernel.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace lancer {
namespace {

// Ordinary numbers, lattice points, numbers without a fraction, of the largest size, and none.
TextureInputs inputs_of(int seed) {
  std::mt19937 random(static_cast<uint32_t>(seed));
  std::uniform_real_distribution<float> ordinary(-8.0f, 8.0f), share(0.0f, 1.0f);
  const float infinite = std::numeric_limits<float>::infinity();
  const float special[] = {0.0f,  -0.0f, 1.0f,  -3.0f,  1e-30f,   1e5f,      -1e5f,         1.5e6f,
                           -3e9f, 1e20f, 3e38f, -3e38f, infinite, -infinite, std::nanf(""), 0x1p23f};
  TextureInputs result;
  for (auto &row : result.x)
    for (float &x : row)
      x = seed % 3 == 0 && random() % 4 == 0 ? special[random() % std::size(special)]
          : random() % 3 == 0                ? share(random)
                                             : ordinary(random);
  return result;
}

// Names the first number whose bits differ; all not-a-numbers are equal.
::testing::AssertionResult equal_bits(const TextureOutputs &a, const TextureOutputs &b) {
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < TextureInputs::kPlaces; ++i)
      if (as_word(a.x[k][i]) != as_word(b.x[k][i]) && !(std::isnan(a.x[k][i]) && std::isnan(b.x[k][i])))
        return ::testing::AssertionFailure() << "number " << k << " of lane " << i << ": " << a.x[k][i] << ", " << b.x[k][i];
  return ::testing::AssertionSuccess();
}

// formula(kernel, in, out) on the inputs of so many seeds.
template <class Formula> void expect_equal(int seeds, const Formula &formula) {
  for (int seed = 0; seed < seeds; ++seed) {
    const TextureInputs in = inputs_of(seed);
    TextureOutputs alone, lanes;
    formula(one_lane::texture_kernel, in, alone);
    for (const TextureKernel *kernel : LANCER_EACH_KERNEL(texture_kernel)) {
      formula(*kernel, in, lanes);
      EXPECT_TRUE(equal_bits(alone, lanes)) << kernel->name << ", seed " << seed;
    }
  }
}

TEST(NodesWidths, Noise) {
  for (uint32_t kind = 0; kind < LANCER_NOISE_COUNT; ++kind)
    for (uint32_t flags = 0; flags < 64; ++flags) {
      SCOPED_TRACE("kind " + std::to_string(kind) + " flags " + std::to_string(flags));
      expect_equal(
          6, [&](const TextureKernel &k, const TextureInputs &in, TextureOutputs &out) { k.noise(kind, flags, in, out); });
    }
}

TEST(NodesWidths, Voronoi) {
  for (uint32_t feature = 0; feature < LANCER_VORONOI_COUNT; ++feature)
    for (uint32_t flags = 0; flags < 512; ++flags) {
      SCOPED_TRACE("feature " + std::to_string(feature) + " flags " + std::to_string(flags));
      // Hundreds of cells each, of which four dimensions have the most.
      if (feature != LANCER_VORONOI_SMOOTH_F1 || (flags & 3) != 3 || flags % 16 == 3 || flags % 16 == 15)
        expect_equal((flags & 3) == 3 ? 1 : 3, [&](const TextureKernel &k, const TextureInputs &in, TextureOutputs &out) {
          k.voronoi(feature, flags, in, out);
        });
    }
}

TEST(NodesWidths, Gradient) {
  for (uint32_t kind = 0; kind < LANCER_GRADIENT_COUNT; ++kind)
    expect_equal(300, [&](const TextureKernel &k, const TextureInputs &in, TextureOutputs &out) { k.gradient(kind, in, out); });
}

TEST(NodesWidths, Curves) {
  std::array<float, 4 * 7> values;
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = float(i * i % 17) - 5.0f;
  for (const uint32_t stride : {1u, 3u, 4u})
    for (const bool extrapolates : {false, true})
      for (const bool interpolates : {false, true}) {
        const CurveTable table{values.data(), 7, stride, -2.0f, 3.5f, extrapolates, interpolates};
        expect_equal(300,
                     [&](const TextureKernel &k, const TextureInputs &in, TextureOutputs &out) { k.curve(table, in, out); });
      }
}

} // namespace
} // namespace lancer
