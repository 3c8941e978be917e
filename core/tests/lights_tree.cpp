// Light trees for few and many lights: probabilities equal the frequencies of choices, they sum to one, and no contributing
// light is left out.
#include "light_choosers.h"
#include "lights/light_tree.h"
#include "lights/sample_light.h"
#include "statistics.h"

#include <gtest/gtest.h>

namespace lancer {
namespace {

using testing::Random;

glm::dvec3 somewhere(Random &random, double size) {
  return size * (2.0 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0);
}

glm::dvec3 direction(Random &random) {
  glm::dvec3 v;
  do
    v = somewhere(random, 1.0);
  while (glm::dot(v, v) > 1.0 || glm::dot(v, v) < 1e-3);
  return glm::normalize(v);
}

// Lamps of every kind, with powers across six orders of magnitude, some with and some without extent.
Light any_light(Random &random, double size) {
  Light light;
  light.kind = LightKind(random.next() % 4);
  light.position = somewhere(random, size);
  light.z = direction(random);
  light.x = glm::normalize(glm::cross(light.z, direction(random)));
  light.y = glm::cross(light.z, light.x);
  light.emission = glm::dvec3(std::pow(10.0, 6.0 * double(random.uniform()) - 3.0));
  light.soft_falloff = random.next() % 2;
  light.radius = random.next() % 2 ? 0.1 * size * double(random.uniform()) : 0.0;
  light.cos_half_angle = double(random.uniform());
  light.blend_width = (1.0 - light.cos_half_angle) * double(random.uniform());
  light.stretch_x = 0.5 + double(random.uniform());
  light.stretched = true;
  light.one_minus_cos_sun = random.next() % 2 ? 0.5 * double(random.uniform()) : 0.0;
  light.half_x = 0.1 * size * double(random.uniform());
  light.half_y = 0.1 * size * double(random.uniform());
  light.skew = random.next() % 2 ? 0.2 * size * (double(random.uniform()) - 0.5) : 0.0;
  light.area = 4.0 * light.half_x * light.half_y;
  if (random.next() % 2) {
    const double half = 0.1 + double(random.uniform());
    light.tan_half_spread = std::tan(half);
    light.spread_scale = 1.0 / (light.tan_half_spread - half);
  }
  return light;
}

std::vector<Light> any_lights(Random &random, uint32_t count, double size = 400.0) {
  std::vector<Light> lights;
  for (uint32_t i = 0; i < count; ++i)
    lights.push_back(any_light(random, size));
  return lights;
}

// Lights without a position are only for the tree of few.
template <class Tree> Tree tree_of(const std::vector<Light> &lights, bool sky = false) {
  constexpr bool few = std::is_same_v<Tree, BinaryLightTree>;
  std::vector<DescribedLight> described;
  for (uint32_t i = 0; i < lights.size(); ++i)
    if (few || lights[i].kind != LightKind::Sun)
      described.push_back(describe(lights[i], i));
  if (sky && few)
    described.push_back(describe_sky(0.01, uint32_t(lights.size())));
  return Tree(std::move(described), uint32_t(lights.size()) + 1);
}

// Triangles in a cube.
template <class Tree> Tree tree_of_faces(Random &random, uint32_t count) {
  std::vector<DescribedLight> faces;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 p = somewhere(random, 500.0);
    const glm::dvec3 corners[3] = {p, p + somewhere(random, 20.0), p + somewhere(random, 20.0)};
    faces.push_back(describe_triangle(corners, double(random.uniform()) + 0.01, i));
  }
  return Tree(std::move(faces), count);
}

LightQuery any_query(Random &random, double size = 500.0) {
  return LightQuery(somewhere(random, size), glm::vec3(direction(random)), random.next() % 4 == 0);
}

// Sums over some dozen shares in double, each with a few roundings.
constexpr double kSumError = 1e-13;

// Clusters may have an upper bound that none of their lights reaches: then there is no choice, and the sum stays below 1.
template <class Tree> double sum_of(const Tree &tree, uint32_t count, const LightQuery &query) {
  double sum = 0.0;
  for (uint32_t i = 0; i < count; ++i) {
    const double p = tree.probability(query, i);
    EXPECT_GE(p, 0.0);
    sum += p;
  }
  EXPECT_LE(sum, 1.0 + kSumError * std::sqrt(double(count)));
  return sum;
}

template <class Tree> void expect_sum_of_one(const Tree &tree, uint32_t count, const LightQuery &query) {
  EXPECT_NEAR(sum_of(tree, count, query), 1.0, kSumError * std::sqrt(double(count)));
}

template <class Tree> class LightTrees : public ::testing::Test {};
using BothTrees = ::testing::Types<BinaryLightTree, LightTree>;
TYPED_TEST_SUITE(LightTrees, BothTrees);

TYPED_TEST(LightTrees, ProbabilitiesAddUpToOne) {
  Random random(1);
  for (const uint32_t count : {1u, 2u, 3u, 8u, 9u, 30u, 200u, 3000u, 20000u}) {
    // Lamps that shine in all directions, on a transparent surface: every bound is reached.
    std::vector<Light> points = any_lights(random, count);
    for (Light &light : points)
      light.kind = LightKind::Point;
    const uint32_t with_sky = count + 1;
    const TypeParam lamps = tree_of<TypeParam>(points, count % 2),
                    all = tree_of<TypeParam>(any_lights(random, count), count % 2);
    const TypeParam faces = tree_of_faces<TypeParam>(random, count);
    for (int i = 0; i < (count < 100 ? 50 : count < 10000 ? 10 : 2); ++i) {
      const LightQuery query = any_query(random), through(query.p, query.n, true);
      expect_sum_of_one(lamps, with_sky, through);
      expect_sum_of_one(faces, count, through);
      for (const TypeParam *tree : {&lamps, &all, &faces})
        sum_of(*tree, with_sky, query);
    }
  }
}

TYPED_TEST(LightTrees, TheProbabilityOfAChoiceIsThatOfItsLight) {
  Random random(2);
  for (const uint32_t count : {1u, 2u, 5u, 40u, 1000u, 5000u}) {
    const TypeParam tree = tree_of<TypeParam>(any_lights(random, count), true), faces = tree_of_faces<TypeParam>(random, count);
    for (const TypeParam *each : {&tree, &faces})
      for (int i = 0; i < 500; ++i) {
        const LightQuery query = any_query(random);
        const LightChoice choice = choose(*each, query, double(random.uniform()));
        ASSERT_GE(choice.u, 0.0);
        ASSERT_LT(choice.u, 1.0);
        // The same factors in the other order: a rounding for each level, of which there are some dozens.
        if (!(choice.probability > 0.0))
          continue;
        EXPECT_NEAR(each->probability(query, choice.number), choice.probability, 64.0 * 0x1p-53 * choice.probability);
      }
  }
}

TYPED_TEST(LightTrees, ChoicesFollowTheirProbabilities) {
  Random random(3);
  constexpr int kQueries = 24, kChoices = 50000;
  for (const uint32_t count : {2u, 7u, 25u, 200u}) {
    const TypeParam tree = tree_of<TypeParam>(any_lights(random, count), true);
    for (int k = 0; k < kQueries; ++k) {
      const LightQuery query = any_query(random);
      std::vector<double> expected(count + 2), observed(count + 2);
      double sum = 0.0;
      for (uint32_t i = 0; i <= count; ++i)
        sum += expected[i] = kChoices * tree.probability(query, i);
      // The remainder is no choice, unless it is rounding.
      expected[count + 1] = kChoices - sum > kChoices * kSumError * std::sqrt(double(count)) ? kChoices - sum : 0.0;
      for (int i = 0; i < kChoices; ++i) {
        const LightChoice choice = choose(tree, query, (i + double(random.uniform())) / kChoices);
        ++observed[choice.probability > 0.0 ? choice.number : count + 1];
      }
      // Stratified numbers, one in each slice, vary less than the law assumes: all the more is a high statistic an error.
      EXPECT_GT(testing::chi_square_test(observed, expected), testing::sidak_level(testing::kSignificance, 4 * kQueries));
    }
  }
}

TYPED_TEST(LightTrees, WhatIsLeftOfTheNumberIsUniform) {
  Random random(4);
  const TypeParam tree = tree_of<TypeParam>(any_lights(random, 50), true);
  const LightQuery query({0, 0, 0}, {0, 0, 1}, true);
  std::vector<double> counts(20), expected(20);
  for (int i = 0; i < 100000; ++i) {
    const LightChoice choice = choose(tree, query, double(random.uniform()) + 0x1p-24 * double(random.uniform()));
    if (!(choice.probability > 0.0))
      continue;
    ++counts[size_t(20.0 * choice.u)];
    for (double &each : expected)
      each += 1.0 / 20.0;
  }
  EXPECT_GT(testing::chi_square_test(counts, expected), testing::kSignificance);
}

TYPED_TEST(LightTrees, WhateverContributesHasAChance) {
  Random random(5);
  int contributing = 0;
  for (int round = 0; round < 60; ++round) {
    const std::vector<Light> lights = any_lights(random, round < 30 ? 3 : 60);
    const TypeParam tree = tree_of<TypeParam>(lights);
    for (int i = 0; i < 400; ++i) {
      // Also points near a light and surfaces that see it at their very edge.
      const Light &near = lights[random.next() % lights.size()];
      const glm::dvec3 p = i % 2 ? somewhere(random, 500.0) : near.position + somewhere(random, std::pow(10.0, -4.0 + i % 7));
      glm::dvec3 n = direction(random);
      if (i % 3 == 0 && p != near.position)
        n = glm::normalize(glm::cross(n, p - near.position)) + 1e-6 * n;
      const LightQuery query(p, glm::vec3(glm::normalize(n)), false);
      for (uint32_t k = 0; k < lights.size(); ++k) {
        const LightSample s = sample(lights[k], p, {random.uniform(), random.uniform()});
        if (lights[k].kind == LightKind::Sun && std::is_same_v<TypeParam, LightTree>)
          continue;
        if (!(s.pdf > 0.0) || s.radiance == glm::vec3(0.0f) || !(glm::dot(glm::vec3(s.wi), query.n) > 0.0f))
          continue;
        ++contributing;
        EXPECT_GT(tree.probability(query, k), 0.0) << int(lights[k].kind) << " of " << lights.size();
      }
    }
  }
  EXPECT_GT(contributing, 10000);
}

TYPED_TEST(LightTrees, FacesThatAreSeenHaveAChance) {
  Random random(6);
  for (int round = 0; round < 300; ++round) {
    std::vector<DescribedLight> faces;
    std::vector<std::array<glm::dvec3, 3>> corners;
    for (uint32_t i = 0; i < 20; ++i) {
      const glm::dvec3 p = somewhere(random, 500.0);
      corners.push_back({p, p + somewhere(random, 50.0), p + somewhere(random, 50.0)});
      const glm::dvec3 c[3] = {corners[i][0], corners[i][1], corners[i][2]};
      faces.push_back(describe_triangle(c, 1.0, i));
    }
    const TypeParam tree(faces, 20);
    for (int k = 0; k < 20; ++k) {
      const LightQuery query = any_query(random);
      for (uint32_t i = 0; i < 20; ++i) {
        const float a = random.uniform(), b = random.uniform() * (1.0f - a);
        const glm::dvec3 q =
            corners[i][0] + double(a) * (corners[i][1] - corners[i][0]) + double(b) * (corners[i][2] - corners[i][0]);
        if (!query.transmits && !(glm::dot(q - query.p, glm::dvec3(query.n)) > 0.0))
          continue;
        EXPECT_GT(tree.probability(query, i), 0.0);
      }
    }
  }
}

TYPED_TEST(LightTrees, OneLightIsCertain) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const TypeParam tree = tree_of_faces<TypeParam>(random, 1);
    LightQuery query = any_query(random);
    query.transmits = true;
    EXPECT_EQ(tree.probability(query, 0), 1.0);
    EXPECT_EQ(choose(tree, query, 0.9).probability, 1.0);
  }
}

TYPED_TEST(LightTrees, StandsWhatIsDegenerate) {
  Random random(8);
  const auto light = [](const glm::dvec3 &p, double emission) {
    Light result;
    result.position = p;
    result.emission = glm::dvec3(emission);
    return result;
  };
  // Thousands at one place, some of them dark.
  std::vector<Light> lights;
  for (int i = 0; i < 5000; ++i)
    lights.push_back(light({1.0, 2.0, 3.0}, i % 10 ? 1.0 : 0.0));
  const TypeParam heap = tree_of<TypeParam>(lights);
  for (const glm::dvec3 &p : {glm::dvec3(0.0), glm::dvec3(1.0, 2.0, 3.0), glm::dvec3(1e9, 0.0, 0.0)})
    for (const glm::vec3 &n : {glm::vec3(0.0f, 0.0f, 1.0f), glm::vec3(0.0f)})
      expect_sum_of_one(heap, 5000, LightQuery(p, n, true));
  EXPECT_EQ(heap.probability(LightQuery(glm::dvec3(0.0), {0, 0, 1}, true), 0), 0.0);
  // Positions in geometric progression make the deepest tree.
  lights.clear();
  for (int i = 0; i < 1000; ++i)
    lights.push_back(light({std::ldexp(500.0, -i), 0.0, 1.0}, 1.0));
  expect_sum_of_one(tree_of<TypeParam>(lights), 1000, LightQuery(glm::dvec3(0.0), {0, 0, 1}, false));
  // A very bright lamp beside a very dim one: neither loses its probability, wherever they are.
  for (const double away : {1.0, 1e4, 1e8}) {
    const TypeParam tree = tree_of<TypeParam>({light({0.0, 0.0, 1.0}, 1e12), light({0.0, away, 1.0}, 1e-6)});
    for (const glm::dvec3 &p : {glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, away, 0.0)}) {
      const LightQuery query(p, {0, 0, 1}, true);
      EXPECT_GT(tree.probability(query, 0), 0.0);
      EXPECT_GT(tree.probability(query, 1), 0.0);
      expect_sum_of_one(tree, 2, query);
    }
  }
  // One lamp at a distance beyond the range of float does not change the others.
  lights.clear();
  for (int i = 0; i < 6; ++i)
    lights.push_back(light({i ? double(i) : 4e38, 0.0, 1.0}, 1.0));
  for (const bool transmits : {false, true})
    EXPECT_GT(tree_of<TypeParam>(lights).probability(LightQuery(glm::dvec3(0.0), {0, 0, 1}, transmits), 3), 0.01);
  EXPECT_EQ(choose(tree_of<TypeParam>({}), any_query(random), 0.5).probability, 0.0);
}

} // namespace
} // namespace lancer
