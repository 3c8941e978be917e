// Textures and curves at widths 1, 4, 8 and 16: equal bits, whatever the numbers are.
#include "nodes/curves.h"
#include "nodes/gradient.h"
#include "nodes/noise.h"
#include "nodes/voronoi.h"

#include <array>
#include <gtest/gtest.h>
#include <random>

namespace lancer {
namespace {

constexpr int kPlaces = 16, kInputs = 11;

struct Inputs {
  alignas(64) float x[kInputs][kPlaces];
};

// Ordinary numbers, lattice points, numbers without a fraction, of the largest size, and none.
Inputs inputs_of(int seed) {
  std::mt19937 random(static_cast<uint32_t>(seed));
  std::uniform_real_distribution<float> ordinary(-8.0f, 8.0f), share(0.0f, 1.0f);
  const float infinite = std::numeric_limits<float>::infinity();
  const float special[] = {0.0f,  -0.0f, 1.0f,  -3.0f,  1e-30f,   1e5f,      -1e5f,         1.5e6f,
                           -3e9f, 1e20f, 3e38f, -3e38f, infinite, -infinite, std::nanf(""), 0x1p23f};
  Inputs result;
  for (auto &row : result.x)
    for (float &x : row)
      x = seed % 3 == 0 && random() % 4 == 0 ? special[random() % std::size(special)]
          : random() % 3 == 0                ? share(random)
                                             : ordinary(random);
  return result;
}

template <int W> auto lanes(const Inputs &in, int row, int first) { return load_lanes<W>(in.x[row] + first); }
template <int W> auto vector_of(const Inputs &in, int row, int first) {
  using F = decltype(lanes<W>(in, row, first));
  return Vector3<F>{lanes<W>(in, row, first), lanes<W>(in, row + 1, first), lanes<W>(in, row + 2, first)};
}

struct Outputs {
  alignas(64) float x[4][kPlaces] = {};
};

// Where two results differ in their bits; numbers that are none are equal.
testing::AssertionResult equal_bits(const Outputs &a, const Outputs &b) {
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < kPlaces; ++i)
      if (as_word(a.x[k][i]) != as_word(b.x[k][i]) && !(std::isnan(a.x[k][i]) && std::isnan(b.x[k][i])))
        return testing::AssertionFailure() << "number " << k << " of lane " << i << ": " << a.x[k][i] << ", " << b.x[k][i];
  return testing::AssertionSuccess();
}

template <int W, class Formula> Outputs evaluated(const Inputs &in, Formula formula) {
  Outputs out;
  for (int first = 0; first < kPlaces; first += W) {
    const auto value = formula.template operator()<W>(in, first);
    store(out.x[0] + first, value.vector.x);
    store(out.x[1] + first, value.vector.y);
    store(out.x[2] + first, value.vector.z);
    store(out.x[3] + first, value.number);
  }
  return out;
}

template <class Formula> void expect_equal(int seeds, Formula formula) {
  for (int seed = 0; seed < seeds; ++seed) {
    const Inputs in = inputs_of(seed);
    const Outputs narrow = evaluated<1>(in, formula);
    EXPECT_TRUE(equal_bits(narrow, evaluated<4>(in, formula))) << "width 4, seed " << seed;
    EXPECT_TRUE(equal_bits(narrow, evaluated<8>(in, formula))) << "width 8, seed " << seed;
    EXPECT_TRUE(equal_bits(narrow, evaluated<16>(in, formula))) << "width 16, seed " << seed;
  }
}

template <class F> VoronoiValue<F> beside(const Vector3<F> &vector) { return {vector, vector.x}; }

struct NoiseFormula {
  uint32_t kind, flags;
  template <int W> auto operator()(const Inputs &in, int first) const {
    using F = decltype(lanes<W>(in, 0, first));
    return beside(noise_texture<F>(kind, flags, vector_of<W>(in, 0, first), vector_of<W>(in, 3, first),
                                   vector_of<W>(in, 6, first), vector_of<W>(in, 8, first)));
  }
};

struct VoronoiFormula {
  uint32_t feature, flags;
  template <int W> auto operator()(const Inputs &in, int first) const {
    using F = decltype(lanes<W>(in, 0, first));
    return voronoi_texture<F>(feature, flags, vector_of<W>(in, 0, first), vector_of<W>(in, 3, first),
                              vector_of<W>(in, 6, first), vector_of<W>(in, 8, first));
  }
};

struct GradientFormula {
  uint32_t kind;
  template <int W> auto operator()(const Inputs &in, int first) const {
    using F = decltype(lanes<W>(in, 0, first));
    return beside(Vector3<F>(gradient_texture<F>(kind, vector_of<W>(in, 0, first))));
  }
};

struct CurveFormula {
  CurveTable table;
  template <int W> auto operator()(const Inputs &in, int first) const {
    using F = decltype(lanes<W>(in, 0, first));
    return beside(on_curves<F>(table, lanes<W>(in, 3, first), vector_of<W>(in, 0, first)));
  }
};

TEST(NodesWidths, Noise) {
  for (uint32_t kind = 0; kind < LANCER_NOISE_COUNT; ++kind)
    for (uint32_t flags = 0; flags < 64; ++flags) {
      SCOPED_TRACE("kind " + std::to_string(kind) + " flags " + std::to_string(flags));
      expect_equal(6, NoiseFormula{kind, flags});
    }
}

TEST(NodesWidths, Voronoi) {
  for (uint32_t feature = 0; feature < LANCER_VORONOI_COUNT; ++feature)
    for (uint32_t flags = 0; flags < 512; ++flags) {
      SCOPED_TRACE("feature " + std::to_string(feature) + " flags " + std::to_string(flags));
      // Hundreds of cells each, of which four dimensions have the most.
      if (feature != LANCER_VORONOI_SMOOTH_F1 || (flags & 3) != 3 || flags % 16 == 3 || flags % 16 == 15)
        expect_equal((flags & 3) == 3 ? 1 : 3, VoronoiFormula{feature, flags});
    }
}

TEST(NodesWidths, Gradient) {
  for (uint32_t kind = 0; kind < LANCER_GRADIENT_COUNT; ++kind)
    expect_equal(300, GradientFormula{kind});
}

TEST(NodesWidths, Curves) {
  std::array<float, 4 * 7> values;
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = float(i * i % 17) - 5.0f;
  for (const uint32_t stride : {1u, 3u, 4u})
    for (const bool extrapolates : {false, true})
      for (const bool interpolates : {false, true})
        expect_equal(300, CurveFormula{{values.data(), 7, stride, -2.0f, 3.5f, extrapolates, interpolates}});
}

} // namespace
} // namespace lancer
