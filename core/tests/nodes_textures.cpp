// Procedural textures and curves: their invariants; blender_tests compares with Blender's own values.
#include "nodes_lab.h"

#include "nodes/curves.h"
#include "nodes/noise.h"
#include "nodes/run.h"
#include "nodes/texture_nodes.h"
#include "nodes/voronoi.h"

#include <cmath>
#include <limits>
#include <random>

using namespace lancer_test;

namespace {

using V = Vector3<float>;
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr uint32_t k3D = 2;

float noise_at(uint32_t kind, uint32_t flags, const V &p, float detail, float roughness = 0.5f) {
  return noise_texture<float>(kind, flags, p, {0.3f, 1.0f, 0.0f}, {detail, roughness, 2.0f}, {0.4f, 1.5f, 0.0f}).x;
}

std::vector<V> places(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> share(-20.0f, 20.0f);
  std::vector<V> result;
  for (int i = 0; i < count; ++i)
    result.push_back({share(random), share(random), share(random)});
  return result;
}

TEST(NodesNoise, PeriodIsTheExactRemainder) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> share(-1.0f, 1.0f);
  for (int exponent = -20; exponent < 128; ++exponent)
    for (int i = 0; i < 2000; ++i) {
      const float x = std::ldexp(share(random), exponent);
      ASSERT_EQ(within_period(x), std::fmod(x, kNoisePeriod)) << x;
    }
  for (const float x : {-0.0f, 1e5f, -1e5f, 3e5f, std::numeric_limits<float>::max()})
    EXPECT_EQ(within_period(x), std::fmod(x, kNoisePeriod)) << x;
}

TEST(NodesNoise, IsNothingAtLatticePointsAndWherePlacesAreNoNumbers) {
  for (uint32_t dimensions = 0; dimensions < 4; ++dimensions) {
    const V whole{3.0f, -7.0f, 12.0f}, octaves{0.0f, 0.5f, 2.0f}, shape{0.0f, 1.0f, 0.0f};
    EXPECT_EQ(noise_texture<float>(LANCER_NOISE_FBM, dimensions, whole, {5.0f, 1.0f, 0.0f}, octaves, shape).x, 0.0f);
    for (const float bad : {kInfinite, -kInfinite, std::nanf("")})
      for (const uint32_t repeats : {0u, uint32_t(LANCER_NOISE_REPEATS)})
        EXPECT_EQ(noise_texture<float>(LANCER_NOISE_FBM, dimensions | repeats | LANCER_NOISE_NORMALIZED, {bad, bad, 0.5f},
                                       {bad, 1.0f, 0.0f}, octaves, shape)
                      .x,
                  0.5f);
  }
}

TEST(NodesNoise, StaysWithinItsRange) {
  float least = 1.0f, most = 0.0f;
  for (const V &p : places(20000)) {
    const float value = noise_at(LANCER_NOISE_FBM, k3D | LANCER_NOISE_NORMALIZED, p, 3.4f, 0.7f);
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_GE(least, 0.0f);
  EXPECT_LE(most, 1.0f);
  // And it is not flat.
  EXPECT_LT(least, 0.3f);
  EXPECT_GT(most, 0.7f);
}

TEST(NodesNoise, AFractionOfAnOctaveLiesBetweenItsNeighbours) {
  const uint32_t flags = k3D | LANCER_NOISE_NORMALIZED;
  for (const V &p : places(200)) {
    const float low = noise_at(LANCER_NOISE_FBM, flags, p, 1.0f), high = noise_at(LANCER_NOISE_FBM, flags, p, 2.0f);
    // Three roundings of numbers below 1.
    EXPECT_NEAR(noise_at(LANCER_NOISE_FBM, flags, p, 1.25f), 0.75f * low + 0.25f * high, 3 * 0x1p-24f);
  }
}

TEST(NodesNoise, OctavesThatAreCountedAreOneMore) {
  for (uint32_t kind = 0; kind < LANCER_NOISE_COUNT; ++kind)
    for (const V &p : places(50)) {
      EXPECT_EQ(noise_at(kind, k3D | LANCER_NOISE_COUNTED, p, 4.0f), noise_at(kind, k3D, p, 3.0f));
      // Without an octave, sums are 0 and products are 1; terrains have their first.
      const float none = noise_at(kind, k3D | LANCER_NOISE_COUNTED, p, 0.0f);
      if (kind == LANCER_NOISE_FBM || kind == LANCER_NOISE_HYBRID_MULTIFRACTAL)
        EXPECT_EQ(none, 0.0f);
      else
        EXPECT_EQ(none, kind == LANCER_NOISE_MULTIFRACTAL ? 1.0f : noise_at(kind, k3D, p, 0.0f));
    }
}

TEST(NodesNoise, RedIsTheValueAndOthersAreOtherNoise) {
  int same = 0;
  for (const V &p : places(100)) {
    const V place{0.3f, 1.0f, 0.8f}, octaves{2.0f, 0.5f, 2.0f}, shape{0.0f, 1.0f, 0.0f};
    const V value = noise_texture<float>(LANCER_NOISE_FBM, k3D, p, place, octaves, shape);
    const V color = noise_texture<float>(LANCER_NOISE_FBM, k3D | LANCER_NOISE_COLOR, p, place, octaves, shape);
    EXPECT_EQ(value.y, value.x);
    EXPECT_EQ(color.x, value.x);
    same += color.y == color.x || color.z == color.x || color.y == color.z;
  }
  EXPECT_EQ(same, 0);
}

VoronoiValue<float> cells_at(uint32_t feature, uint32_t flags, const V &p, float smoothness = 1.0f) {
  return voronoi_texture<float>(feature, flags, p, {0.0f, 1.0f, 1.0f}, {0.0f, 0.5f, 2.0f}, {smoothness, 2.0f, 0.0f});
}
uint32_t by_metric(uint32_t metric) { return k3D | metric << 2; }

TEST(NodesVoronoi, ThePointIsAsFarAsItSays) {
  for (const uint32_t hash : {0u, uint32_t(LANCER_VORONOI_INTEGERS)})
    for (const uint32_t feature : {uint32_t(LANCER_VORONOI_F1), uint32_t(LANCER_VORONOI_F2)})
      for (const V &p : places(300)) {
        const uint32_t flags = k3D | hash;
        const V point = cells_at(feature, flags | LANCER_VORONOI_POSITION, p).vector;
        const VoronoiValue<float> value = cells_at(feature, flags | LANCER_VORONOI_COLOR, p);
        const V way = point - p;
        // Coordinates up to 22 have three roundings of 2^-20.
        EXPECT_NEAR(std::sqrt(dot(way, way)), value.number, 3 * 0x1p-20f);
        if (feature != LANCER_VORONOI_F1)
          continue;
        const VoronoiValue<float> there = cells_at(feature, flags | LANCER_VORONOI_COLOR, point);
        EXPECT_LE(there.number, 3 * 0x1p-20f);
        EXPECT_TRUE(same(there.vector, value.vector));
      }
}

TEST(NodesVoronoi, FeaturesAreInOrder) {
  for (const V &p : places(300)) {
    const auto number = [&](uint32_t feature, uint32_t metric) { return cells_at(feature, by_metric(metric), p).number; };
    const float first = number(LANCER_VORONOI_F1, LANCER_VORONOI_EUCLIDEAN);
    const float second = number(LANCER_VORONOI_F2, LANCER_VORONOI_EUCLIDEAN);
    EXPECT_LE(first, second);
    // The plane between the nearest points is nearer than half the difference of their distances; rounding is below 2^-20.
    EXPECT_GE(number(LANCER_VORONOI_DISTANCE_TO_EDGE, 0) + 0x1p-20f, 0.5f * (second - first));
    EXPECT_LE(number(LANCER_VORONOI_F1, LANCER_VORONOI_CHEBYCHEV), first);
    EXPECT_GE(number(LANCER_VORONOI_F1, LANCER_VORONOI_MANHATTAN), first);
    // Its exponent is 2 here. Each power has an error of a unit in the last place.
    EXPECT_NEAR(number(LANCER_VORONOI_F1, LANCER_VORONOI_MINKOWSKI), first, 6 * 0x1p-24f);
    EXPECT_EQ(cells_at(LANCER_VORONOI_SMOOTH_F1, k3D, p, 0.0f).number, first);
    EXPECT_LE(cells_at(LANCER_VORONOI_SMOOTH_F1, k3D, p, 1.0f).number, first);
  }
}

TEST(NodesVoronoi, TheBoundIsBeyondOrdinaryDistances) {
  for (const V &p : places(100))
    for (uint32_t feature = 0; feature < LANCER_VORONOI_COUNT; ++feature)
      EXPECT_EQ(cells_at(feature, k3D | LANCER_VORONOI_BOUNDED, p).number, cells_at(feature, k3D, p).number);
  // With an exponent of a tenth the nearest point is farther.
  const V form{1.0f, 0.1f, 0.0f}, octaves{0.0f, 0.5f, 2.0f};
  const uint32_t flags = by_metric(LANCER_VORONOI_MINKOWSKI);
  const auto distance = [&](uint32_t more) {
    return voronoi_texture<float>(LANCER_VORONOI_F1, flags | more, {0.3f, 0.6f, 0.2f}, {0.0f, 1.0f, 1.0f}, octaves, form)
        .number;
  };
  EXPECT_GT(distance(0), 8.0f);
  // The power of a power: the tenth root of the eightieth of a unit in the last place.
  EXPECT_NEAR(distance(LANCER_VORONOI_BOUNDED), 8.0f, 8.0f * 80 * 0x1p-24f);
}

TEST(NodesGradient, ClosedForms) {
  const V p{0.3f, 0.4f, 0.0f};
  const auto at = [](uint32_t kind, const V &place) { return gradient_texture<float>(kind, place); };
  EXPECT_EQ(at(LANCER_GRADIENT_LINEAR, p), 0.3f);
  EXPECT_EQ(at(LANCER_GRADIENT_QUADRATIC, p), 0.3f * 0.3f);
  EXPECT_FLOAT_EQ(at(LANCER_GRADIENT_EASING, p), 0.09f * (3.0f - 0.6f));
  EXPECT_FLOAT_EQ(at(LANCER_GRADIENT_DIAGONAL, p), 0.35f);
  EXPECT_NEAR(at(LANCER_GRADIENT_SPHERICAL, p), 0.499999f, 0x1p-24f);
  EXPECT_NEAR(at(LANCER_GRADIENT_QUADRATIC_SPHERE, p), 0.499999f * 0.499999f, 0x1p-24f);
  EXPECT_NEAR(at(LANCER_GRADIENT_RADIAL, p), std::atan2(0.4, 0.3) / (2.0 * 3.14159265358979) + 0.5, 0x1p-24f);
  EXPECT_EQ(at(LANCER_GRADIENT_SPHERICAL, {0.6f, 0.0f, 0.8f}), 0.0f);
  for (uint32_t kind = 0; kind < LANCER_GRADIENT_COUNT; ++kind)
    for (const float far : {1e30f, -1e30f, kInfinite, -kInfinite, std::nanf("")}) {
      const float value = at(kind, {far, far, far});
      EXPECT_TRUE(value >= 0.0f && value <= 1.0f) << kind << " " << far;
    }
}

TEST(NodesGabor, IsFiniteForAllFrequencies) {
  for (const bool in_space : {false, true})
    for (const float frequency : {2.0f, kInfinite})
      for (const V &p : places(50)) {
        const V got = gabor_texture<float>(in_space, p, {1.0f, frequency, 0.5f}, {0.3f, 0.8f, 0.5f});
        EXPECT_TRUE(std::isfinite(got.x) && std::isfinite(got.y) && std::isfinite(got.z)) << in_space << " " << frequency;
      }
}

// x^2 at 0, 1/2, 1 in the first channel, -x in the second, 7 in the third.
constexpr float kTable[] = {0.0f, -0.0f, 7.0f, 0.25f, -0.5f, 7.0f, 1.0f, -1.0f, 7.0f};

TEST(NodesCurves, LinesAndTheirContinuations) {
  CurveTable table{kTable, 3, 3};
  EXPECT_EQ(on_curve(table, 0, 0.25f), 0.125f);
  EXPECT_EQ(on_curve(table, 1, 0.75f), -0.75f);
  EXPECT_EQ(on_curve(table, 0, 1.0f), 1.0f);
  EXPECT_EQ(on_curve(table, 0, -3.0f), 0.0f);
  EXPECT_EQ(on_curve(table, 0, 3.0f), 1.0f);
  EXPECT_EQ(on_curve(table, 0, std::nanf("")), 0.0f);
  table.extrapolates = true;
  // Slopes of 1/2 and 3/2.
  EXPECT_EQ(on_curve(table, 0, -1.0f), -0.5f);
  EXPECT_EQ(on_curve(table, 0, 2.0f), 2.5f);
  EXPECT_EQ(on_curve(table, 0, 0.25f), 0.125f);
  table.interpolates = false;
  EXPECT_EQ(on_curve(table, 0, 0.4375f), 0.0f);
  EXPECT_EQ(on_curve(table, 0, 0.5f), 0.25f);
  table = {kTable, 3, 3, -2.0f, 2.0f};
  EXPECT_EQ(on_curve(table, 0, 0.0f), 0.25f);
  const V half = on_curves<float>(table, 0.5f, {0.0f, 2.0f, 1.0f});
  EXPECT_TRUE(same(half, V(0.125f, 0.5f, 4.0f)));
}

class Tables : public Stage {
public:
  explicit Tables(uint32_t channels, uint32_t width = 3) {
    std::vector<float> texels(kTable, kTable + width * channels);
    add_image(description, image_of(texels, width, 1, channels));
  }
};

TEST(NodesCurves, ReadTheRowOfAPicture) {
  const lancer_node curves = node(LANCER_NODE_CURVES, 0, {constant(1.0f), constant(0.25f, 0.75f, 0.1f)});
  lancer_node ends = curves;
  ends.matrix[0] = 0.0f;
  ends.matrix[1] = 1.0f;
  expect_near(glm::vec3(Tables(3).value({ends})), {0.125f, -0.75f, 7.0f}, 0.0f);
  ends.option = 1;
  expect_near(glm::vec3(Tables(3).value({ends})), {0.125f, -0.25f, 7.0f}, 0.0f);
  ends.option = 0;
  // A single curve applies to x only.
  const float between = 0.5f * kTable[0] + 0.5f * kTable[1];
  expect_near(glm::vec3(Tables(1).value({ends})), glm::vec3(between), 0.0f);
}

TEST(NodesCurves, RefusesWhatIsNoTable) {
  const auto refusal = [](Description &&description, uint32_t image) {
    lancer_node curves = node(LANCER_NODE_CURVES);
    curves.image = image;
    try {
      read_program(description.images, "test", &curves, 1);
    } catch (const std::exception &error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(std::move(Tables(3).description), 0), "");
  EXPECT_EQ(refusal(std::move(Tables(3).description), 1), "test: node 0: image 1 >= 1 images");
  EXPECT_EQ(refusal(std::move(Tables(3, 1).description), 0),
            "test: node 0: image 0 is not a row of at least two floating-point texels");
  Description description;
  const std::vector<uint8_t> bytes = {1, 2};
  add_image(description, image_of(bytes, 2, 1, 1));
  EXPECT_EQ(refusal(std::move(description), 0), "test: node 0: image 0 is not a row of at least two floating-point texels");
}

glm::vec4 grey(float value) { return {value, value, value, 1.0f}; }

TEST(NodesObjectInfo, TellsWhatWasGiven) {
  Stage stage({2, 0, 0, 5, 0, 2, 0, 6, 0, 0, 2, 7});
  stage.description.instances[0].object_index = 9;
  EXPECT_EQ(stage.value({node(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_COLOR)}), glm::vec4(1.0f));
  EXPECT_EQ(stage.value({node(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_RANDOM)}), grey(0.0f));
  stage.description.instances_given = 1;
  const float info[] = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f};
  set_object_infos(stage.description, 1, info);
  EXPECT_EQ(stage.value({node(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_COLOR)}), glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(stage.value({node(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_RANDOM)}), grey(0.5f));
  EXPECT_EQ(stage.value({node(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_INDEX)}), grey(9.0f));
  stage.normalise({1.0, 1.0, 1.0}, 0.25);
  EXPECT_EQ(stage.value({node(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_LOCATION)}), glm::vec4(5.0f, 6.0f, 7.0f, 1.0f));
  // The world is not an object.
  EXPECT_EQ(stage.value_at({node(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_COLOR)}, nullptr), glm::vec4(0.0f));
  EXPECT_THROW(set_object_infos(stage.description, 2, info), std::exception);
  const float bad[] = {0.1f, 0.2f, 0.3f, 0.4f, kInfinite};
  EXPECT_THROW(set_object_infos(stage.description, 1, bad), std::exception);
}

TEST(NodesObjectInfo, ReadsAttributesByNameAndNumber) {
  Stage stage({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  Description &description = stage.description;
  const auto value = [&](const char *name) {
    lancer_node reader = node(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_ATTRIBUTE);
    reader.name = name;
    return stage.value({reader});
  };
  const glm::vec4 none(0.0f);
  EXPECT_EQ(value("heat"), none);
  description.instances_given = 3;
  const float heat[] = {0.1f, 0.2f, 0.3f, 0.4f, -1.0f, 2.0f, 3.0f, 4.0f}, cold[] = {5.0f, 6.0f, 7.0f, 8.0f};
  add_object_attribute(description, "heat", 2, heat);
  add_object_attribute(description, "cold", 1, cold);
  EXPECT_EQ(value("heat"), glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(value("cold"), glm::vec4(5.0f, 6.0f, 7.0f, 8.0f));
  EXPECT_EQ(value("warm"), none);
  EXPECT_EQ(value(""), none);
  // Rows are numbered in the order of adding, and an instance beyond the last row has 0.
  description.instances[0].number = 1;
  EXPECT_EQ(value("heat"), glm::vec4(-1.0f, 2.0f, 3.0f, 4.0f));
  EXPECT_EQ(value("cold"), none);
  EXPECT_EQ(stage.value_at({node(LANCER_NODE_OBJECT_INFO, LANCER_OBJECT_ATTRIBUTE)}, nullptr), grey(0.0f));
}

TEST(NodesObjectInfo, RefusesWrongAttributes) {
  Description description;
  description.instances_given = 1;
  const float good[] = {0.0f, 1.0f, 2.0f, 3.0f, 0.0f, 0.0f, 0.0f, 0.0f}, bad[] = {0.0f, 0.0f, 0.0f, kInfinite};
  const auto refusal = [&](const char *name, uint32_t count, const float *values) {
    try {
      add_object_attribute(description, name, count, values);
    } catch (const std::exception &error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal("heat", 2, good), "object attribute 'heat': 2 for 1 instances");
  EXPECT_EQ(refusal("heat", 1, bad), "object attribute 'heat': number 3 of instance 0 is inf");
  EXPECT_EQ(refusal(nullptr, 1, good), "object attribute '': name is NULL");
  EXPECT_EQ(refusal("heat", 1, good), "");
  EXPECT_EQ(refusal("heat", 1, good), "object attribute 'heat': was added before");
  EXPECT_EQ(description.object_attributes.size(), 1u);
}

TEST(NodesLightPath, TellsKindsAndCounts) {
  LightPath<float> path;
  path.kinds = LANCER_RAY_GLOSSY | kRaySingular | kRayReflected;
  path.length = 2.5f;
  path.depth = 6.0f;
  path.diffuse = 1.0f;
  path.glossy = 2.0f;
  path.transmission = 3.0f;
  path.transparent = 4.0f;
  path.portal = 5.0f;
  const float expected[] = {0, 0, 0, 1, 1, 1, 0, 0, 2.5f, 6, 1, 2, 4, 3, 5};
  static_assert(std::size(expected) == LANCER_PATH_COUNT);
  for (uint32_t which = 0; which < LANCER_PATH_COUNT; ++which)
    EXPECT_EQ(light_path_value(which, path), expected[which]) << which;
}

} // namespace
