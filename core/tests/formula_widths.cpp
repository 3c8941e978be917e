// Every formula gives the bits of one lane in the lanes of each instruction set. All not-a-numbers count as equal: processor
// and compiler choose which of two operands an operation hands on.
#include "light_choosers.h"
#include "widths/each_kernel.h"
#include "widths/width_kernel.h"

#include "lights/light.h"
#include "lights/light_tree.h"
#include "lights/sample_light.h"
#include "sampling/direction_map.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>

namespace lancer {

namespace {

using Random = std::mt19937;

// Zeros of both signs, infinities, what is no number, denormals, the ends of the range, halves and neighbours of 1.
template <class T> T any_number(Random &random) {
  using Limits = std::numeric_limits<T>;
  const T special[] = {T(0),
                       -T(0),
                       T(1),
                       T(-1),
                       Limits::infinity(),
                       -Limits::infinity(),
                       Limits::max(),
                       Limits::min(),
                       -Limits::min(),
                       T(0.5),
                       T(-2.5),
                       Limits::quiet_NaN(),
                       Limits::denorm_min(),
                       -Limits::denorm_min() * T(77),
                       T(1) - Limits::epsilon() / 2};
  if (random() % 2)
    return special[random() % std::size(special)];
  const T share = T(random()) / T(2147483648.0) - T(1);
  return random() % 3 ? share : std::ldexp(share, int(random() % 200) - 100);
}

float any_unit(Random &random) {
  const float special[] = {0.0f, 0.5f, 0.25f, 0x1p-24f, 1.0f - 0x1p-24f, 0.75f};
  return random() % 6 ? float(random() >> 8) * 0x1p-24f : special[random() % std::size(special)];
}

double share(Random &random) { return double(random()) / 4294967296.0; }
glm::dvec3 somewhere(Random &random, double size) {
  const auto along = [&] { return size * (2.0 * share(random) - 1.0); };
  return {along(), along(), along()};
}
glm::dvec3 any_direction(Random &random) { return glm::normalize(somewhere(random, 1.0) + glm::dvec3(1e-9)); }

// Every kind of light, with and without extent, spread, blend and stretch.
Light any_light(Random &random, LightKind kind, double size) {
  Light light;
  light.kind = kind;
  light.position = somewhere(random, size);
  light.z = any_direction(random);
  light.x = glm::normalize(glm::cross(light.z, any_direction(random)));
  light.y = glm::cross(light.z, light.x);
  light.emission = somewhere(random, 5.0) + 5.0;
  light.soft_falloff = random() % 2;
  light.radius = random() % 4 ? size * share(random) : 0.0;
  light.cos_half_angle = share(random);
  light.blend_width = random() % 4 ? (1.0 - light.cos_half_angle) * share(random) : 0.0;
  light.spot_cosine = random() % 2;
  light.stretch_x = random() % 2 ? 0.5 + share(random) : 1.0;
  light.stretched = light.stretch_x != 1.0;
  light.one_minus_cos_sun = random() % 4 ? 0.5 * share(random) : 0.0;
  light.flat_radius = random() % 2 ? share(random) : 0.0;
  light.half_x = size * share(random);
  light.half_y = size * share(random);
  light.skew = random() % 2 ? size * (share(random) - 0.5) : 0.0;
  light.ellipse = light.skew == 0.0 && random() % 2;
  light.area = (light.ellipse ? glm::pi<double>() : 4.0) * light.half_x * light.half_y;
  light.plane_tolerance = random() % 2 ? 1e-3 : 0.0;
  if (random() % 2) {
    light.tan_half_spread = 0.1 + share(random);
    light.spread_scale = 1.0 / (light.tan_half_spread - std::atan(light.tan_half_spread));
  }
  return light;
}

// Of points around the lights, which are within size of the origin, looking mostly at one of them.
void fill(Random &random, double size, const glm::dvec3 &at, WidthInputs &in) {
  for (int lane = 0; lane < WidthInputs::kCount; ++lane) {
    for (auto &row : in.unit)
      row[lane] = any_unit(random);
    for (auto &row : in.number)
      row[lane] = any_number<float>(random);
    for (auto &row : in.wide_number)
      row[lane] = any_number<double>(random);
    for (auto &row : in.word)
      row[lane] = random() % 4 ? random() : random() % 4 ? 0u : ~0u;
    in.whole[lane] = float(4294967040.0 * (share(random) - 0.5)) * (random() % 2 ? 1.0f : 0x1p-30f);
    const glm::dvec3 p = somewhere(random, 2.0 * size), n = any_direction(random);
    const glm::dvec3 wi = random() % 4 ? glm::normalize(at + somewhere(random, 0.5 * size) - p) : any_direction(random);
    for (int axis = 0; axis < 3; ++axis) {
      in.p[axis][lane] = p[axis];
      in.wi[axis][lane] = wi[axis];
      in.n[axis][lane] = float(n[axis]);
    }
    in.end[lane] = 4.0 * size * share(random);
    in.choice[lane] = share(random);
  }
}

bool same(const WidthOutputs &a, const WidthOutputs &b, int row, int lane) {
  const uint64_t x = a.bits[row][lane], y = b.bits[row][lane];
  const auto is_number = [&](uint64_t bits) {
    if (a.is_float[row])
      return !std::isnan(std::bit_cast<float>(uint32_t(bits)));
    return !a.is_double[row] || !std::isnan(std::bit_cast<double>(bits));
  };
  return x == y || (!is_number(x) && !is_number(y));
}

// Compares the formulas of a list, or the one named which, with the same formulas in one lane. Adds up how many numbers were
// compared.
void expect_same(const WidthInputs &in, const WidthFormula *WidthKernel::*list, const char *which, size_t &compared) {
  static WidthOutputs want, got;
  for (const WidthKernel *kernel : LANCER_EACH_KERNEL(width_kernel)) {
    const WidthFormula *formula = kernel->*list;
    for (const WidthFormula *one = one_lane::width_kernel.*list; one->name; ++one, ++formula) {
      if (which && std::string(which) != one->name)
        continue;
      one->run(in, want);
      ASSERT_GT(want.rows, 0);
      ASSERT_LE(want.rows, WidthOutputs::kMost);
      formula->run(in, got);
      ASSERT_EQ(got.rows, want.rows) << one->name;
      for (int row = 0; row < want.rows; ++row)
        for (int lane = 0; lane < WidthInputs::kCount; ++lane)
          ASSERT_TRUE(same(want, got, row, lane)) << one->name << " of " << kernel->name << ", result " << row << ": "
                                                  << std::hex << got.bits[row][lane] << " instead of " << want.bits[row][lane];
      compared += size_t(want.rows) * WidthInputs::kCount;
    }
  }
}

TEST(Widths, NumbersAreThoseOfOneLane) {
  Random random(1);
  WidthInputs in{};
  size_t compared = 0;
  for (int round = 0; round < 3000; ++round) {
    fill(random, 1.0, glm::dvec3(0.0), in);
    ASSERT_NO_FATAL_FAILURE(expect_same(in, &WidthKernel::numbers, nullptr, compared));
  }
  EXPECT_GT(compared, 10000000u);
}

TEST(Widths, SamplesAreThoseOfOneLane) {
  Random random(2);
  const PixelFilter box(FilterKind::Box, 1.3f), window(FilterKind::BlackmanHarris, 1.7f);
  WidthInputs in{};
  size_t compared = 0;
  for (int round = 0; round < 600; ++round) {
    const uint32_t width = 2 + random() % 40, height = 2 + random() % 40;
    std::vector<float> weights(size_t(width) * height);
    for (float &weight : weights)
      weight = random() % 3 ? any_unit(random) : 0.0f;
    weights[0] = 0.5f;
    DirectionMap map(width, height, weights);
    if (round % 2)
      map.add_disc(glm::dvec3(0.0, 0.6, 0.8), 0.001 + 0.7 * double(any_unit(random)), 0.4);
    if (round % 4 == 3)
      map.add_disc(glm::dvec3(0.8, -0.6, 0.0), 0.3, 0.35);
    in.map = map.table();
    in.filter = &(round % 4 ? window : box).table();
    for (int i = 0; i < 4; ++i) {
      fill(random, 1.0, glm::dvec3(0.0), in);
      ASSERT_NO_FATAL_FAILURE(expect_same(in, &WidthKernel::samples, nullptr, compared));
    }
  }
  EXPECT_GT(compared, 1000000u);
}

TEST(Widths, LightsAreThoseOfOneLane) {
  Random random(3);
  WidthInputs in{};
  for (const LightKind kind : {LightKind::Point, LightKind::Spot, LightKind::Sun, LightKind::Area}) {
    SCOPED_TRACE(::testing::Message() << "kind " << uint32_t(kind));
    size_t compared = 0, met = 0;
    for (int round = 0; round < 2000; ++round) {
      // Some blocks of one light, some of sixteen.
      std::vector<Light> lights;
      for (int i = 0; i < WidthInputs::kCount; ++i)
        lights.push_back(i > 0 && round % 4 == 0 ? lights[0] : any_light(random, kind, 2.0));
      for (int lane = 0; lane < WidthInputs::kCount; ++lane)
        in.light[lane] = &lights[size_t(lane)];
      fill(random, 2.0, kind == LightKind::Sun ? 100.0 * lights[0].z : lights[0].position, in);
      for (const char *formula : {"sample_light", "meet_light", "may_meet"})
        ASSERT_NO_FATAL_FAILURE(expect_same(in, &WidthKernel::lights, formula, compared));
      for (int lane = 0; lane < WidthInputs::kCount; ++lane)
        met += meet(lights[0], {in.p[0][lane], in.p[1][lane], in.p[2][lane]}, {in.wi[0][lane], in.wi[1][lane], in.wi[2][lane]})
                   .pdf > 0.0;
    }
    EXPECT_GT(compared, 1000000u);
    EXPECT_GT(met, 300u);
  }
}

TEST(Widths, ImportancesAreThoseOfOneLane) {
  Random random(4);
  WidthInputs in{};
  using Kind = TreeLight::Kind;
  for (const Kind kind : {Kind::Disk, Kind::Ball, Kind::Area, Kind::Sun, Kind::Sky, Kind::Cluster}) {
    SCOPED_TRACE(::testing::Message() << "kind " << uint32_t(kind));
    size_t compared = 0;
    for (int round = 0; round < 2000; ++round) {
      const LightKind of = kind == Kind::Sun    ? LightKind::Sun
                           : kind == Kind::Area ? LightKind::Area
                           : round % 2          ? LightKind::Spot
                                                : LightKind::Point;
      Light light = any_light(random, of, 200.0);
      light.soft_falloff = kind == Kind::Disk;
      const DescribedLight described = kind == Kind::Sky       ? describe_sky(0.3, 0)
                                       : kind == Kind::Cluster ? describe_cluster(describe(light, 0).bounds, 0)
                                                               : describe(light, 0);
      ASSERT_EQ(described.light.kind, kind);
      TreeLight known = described.light;
      known.energy = float(share(random));
      in.tree_light = &known;
      fill(random, 200.0, light.position, in);
      ASSERT_NO_FATAL_FAILURE(expect_same(in, &WidthKernel::lights, "importance", compared));
    }
    EXPECT_GT(compared, 100000u);
  }
}

TEST(Widths, GlowingFacesAreThoseOfOneLane) {
  Random random(6);
  WidthInputs in{};
  size_t compared = 0;
  for (int round = 0; round < 2000; ++round) {
    fill(random, round % 2 ? 2.0 : 1e5, glm::dvec3(0.0), in);
    ASSERT_NO_FATAL_FAILURE(expect_same(in, &WidthKernel::lights, "SeenFace", compared));
  }
  EXPECT_GT(compared, 100000u);
}

TEST(Widths, ChoicesAreThoseOfOneLane) {
  Random random(5);
  WidthInputs in{};
  size_t compared = 0, chosen = 0;
  for (int round = 0; round < 300; ++round) {
    // Near ones and distant ones, in one leaf and in many.
    std::vector<DescribedLight> described;
    const uint32_t count = 2 + random() % 40;
    for (uint32_t i = 0; i < count; ++i)
      described.push_back(describe(any_light(random, LightKind(i % 4), 20.0), i));
    described.push_back(describe(any_light(random, LightKind::Sun, 20.0), count));
    const BinaryLightTree tree(std::move(described), count + 1);
    in.tree = tree.nodes();
    for (int i = 0; i < 4; ++i) {
      fill(random, 200.0, glm::dvec3(0.0), in);
      if (in.tree.root == kNone) {
        ASSERT_NO_FATAL_FAILURE(expect_same(in, &WidthKernel::lights, "pair_shares", compared));
      }
      ASSERT_NO_FATAL_FAILURE(expect_same(in, &WidthKernel::lights, "choose_light", compared));
      ASSERT_NO_FATAL_FAILURE(expect_same(in, &WidthKernel::lights, "choice_probability", compared));
      // As the tree itself chooses.
      for (int lane = 0; lane < WidthInputs::kCount; ++lane) {
        const LightQuery query({in.p[0][lane], in.p[1][lane], in.p[2][lane]}, {in.n[0][lane], in.n[1][lane], in.n[2][lane]},
                               false);
        chosen += choose(tree, query, in.choice[lane]).probability > 0.0;
      }
    }
  }
  EXPECT_GT(compared, 100000u);
  EXPECT_GT(chosen, 10000u);
}

} // namespace
} // namespace lancer
