// Shadow rays through layers: one traversal equals stepping from hit to hit, with the same bits for every accelerator.
#include "foliage.h"
#include "forced_instruction_set.h"

#include "integrator/stages/shadow.h"

#include <algorithm>

namespace lancer_test {
namespace {

constexpr uint32_t kRays = 3000;

// From all sides, infinite or up to a lamp; some have passed layers before.
struct Question {
  Ray ray;
  uint32_t passed;
};
std::vector<Question> questions(const Scene &scene) {
  std::mt19937 random(9);
  const auto number = [&](double low, double high) { return low + (high - low) * double(random() >> 8) * 0x1p-24; };
  const auto anywhere = [&](double size) {
    const double x = number(-size, size), y = number(-size, size), z = number(-size, size);
    return glm::dvec3(x, y, z);
  };
  std::vector<Question> all;
  for (uint32_t i = 0; i < kRays; ++i) {
    Ray ray;
    const glm::dvec3 from = scene.normalisation.to_normalised(anywhere(2.5)),
                     to = scene.normalisation.to_normalised(anywhere(2.5));
    ray.o = from;
    ray.d = i % 3 == 0 ? glm::dvec3(0.01, 0.02, 1.0) : to - from;
    ray.tmax = i % 2 == 0 ? 1.0 : std::numeric_limits<double>::infinity();
    if (i % 3 == 0)
      ray.tmax = std::numeric_limits<double>::infinity();
    ray.kinds = LANCER_RAY_SHADOW;
    all.push_back({ray, i % 5 == 0 ? 3u : 0u});
  }
  return all;
}

// Returns the transmitted part of (1, 1, 1).
std::vector<glm::vec3> one_traversal(const Scene &scene, uint32_t deepest) {
  IntegratorSettings settings;
  settings.transparent_shadows = deepest;
  const Camera camera = camera_above(scene, 1);
  ShadowStage queue(scene, camera, settings);
  uint32_t sample = 0;
  for (const Question &question : questions(scene))
    queue.push(question.ray, {.target = sample++}, glm::vec3(1.0f), question.passed);
  std::vector<glm::vec3> arrived(sample, glm::vec3(0.0f));
  EXPECT_EQ(queue.trace([&](const WaitingLight &waiting, const glm::vec3 &light) { arrived[waiting.target] = light; }), sample);
  return arrived;
}

// The same from hit to hit, by nodes alone.
glm::vec3 from_hit_to_hit(const Scene &scene, Shader &shader, Question question, uint32_t deepest, uint32_t &layers) {
  glm::vec3 light(1.0f);
  Ray ray = question.ray;
  for (layers = 0;; ++layers) {
    Hit hit;
    scene.accelerator->closest_hit({&ray, 1}, {&hit, 1});
    if (!hit.valid())
      return light;
    const Surface surface = surface_at(scene.geometry, scene.slots, ray, hit);
    const MaterialView &material = scene.materials[surface.material];
    if (question.passed + layers >= deepest || !material.is_transparent() || (material.flags & LANCER_MATERIAL_OPAQUE_SHADOWS))
      return glm::vec3(0.0f);
    light *=
        material.transmittance.varies()
            ? glm::vec3(shader.node_value(surface, uint32_t(material.transmittance.node), glm::vec3(-glm::normalize(ray.d))))
            : material.transmittance.value;
    if (light == glm::vec3(0.0f))
      return light;
    Ray next = ray_from(surface, ray.d, ray.tmax);
    if (std::isfinite(next.tmax))
      next.d = ray.o + ray.d * ray.tmax - next.o;
    next.kinds = ray.kinds;
    ray = next;
  }
}

// The number of rays that pass unattenuated or attenuated, and the largest number of layers passed.
struct Arrivals {
  uint32_t lit = 0, dimmed = 0, most = 0;
};

Arrivals expect_the_chain(const Scene &scene, uint32_t deepest) {
  const Camera camera = camera_above(scene, 1);
  const std::vector<glm::vec3> arrived = one_traversal(scene, deepest);
  Shader shader(scene, &camera);
  const std::vector<Question> asked = questions(scene);
  Arrivals arrivals;
  for (uint32_t i = 0; i < kRays; ++i) {
    uint32_t layers = 0;
    const glm::vec3 expected = from_hit_to_hit(scene, shader, asked[i], deepest, layers);
    arrivals.dimmed += expected != glm::vec3(0.0f) && expected != glm::vec3(1.0f);
    arrivals.lit += expected != glm::vec3(0.0f);
    arrivals.most = std::max(arrivals.most, layers);
    // A hit's weights differ by roundings of double, so texture coordinates by one of float, 2^-24 of the image's 16 texels;
    // from one texel to the next alpha changes by at most 1, along two axes: 2^-19 per layer. Products add one more.
    const float bound = float(layers + 1) * (0x1p-19f + 0x1p-24f);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(arrived[i][k], expected[k], bound) << "ray " << i << ", at most " << deepest << " layers";
  }
  return arrivals;
}

TEST(ShadowLayers, OneTraversalIsTheChainOfClosestHits) {
  const auto scene = foliage(Writing::Unknown, {.accelerator = AcceleratorKind::BruteForce});
  for (const uint32_t deepest : {0u, 1u, 4u, 64u}) {
    const Arrivals arrivals = expect_the_chain(*scene, deepest);
    EXPECT_GT(arrivals.lit, 100u);
    if (deepest > 1) {
      EXPECT_GT(arrivals.dimmed, 100u);
      EXPECT_GE(arrivals.most, 4u);
    }
  }
}

TEST(ShadowLayers, SomeLayersAreOpaqueForShadowsOnly) {
  const Planting opaque{.leaf_flags = LANCER_MATERIAL_OPAQUE_SHADOWS};
  for (const Writing writing : {Writing::Unknown, Writing::Plain, Writing::Disguised}) {
    const auto scene = foliage(writing, opaque);
    for (const uint32_t deepest : {1u, 4u}) {
      const Arrivals arrivals = expect_the_chain(*scene, deepest);
      // Panes beside the leaves transmit unchanged.
      EXPECT_GT(arrivals.dimmed, 10u);
    }
    // Leaves block much of the light that they would transmit.
    const auto lit = [](const glm::vec3 &light) { return light != glm::vec3(0.0f); };
    const std::vector<glm::vec3> stopped = one_traversal(*scene, 8), passed = one_traversal(*foliage(writing), 8);
    EXPECT_LT(std::ranges::count_if(stopped, lit), std::ranges::count_if(passed, lit) / 2);
  }
}

TEST(ShadowLayers, EveryAcceleratorGivesTheSameBits) {
  const std::vector<glm::vec3> expected =
      one_traversal(*foliage(Writing::Plain, {.accelerator = AcceleratorKind::BruteForce}), 8);
  EXPECT_EQ(one_traversal(*foliage(Writing::Plain, {.accelerator = AcceleratorKind::KdTree}), 8), expected);
  for (const char *instruction_set : {"sse4", "avx2", "avx512"}) {
    const lancer::test::ForcedInstructionSet asked(instruction_set);
    EXPECT_EQ(one_traversal(*foliage(Writing::Plain), 8), expected) << instruction_set;
  }
}

TEST(ShadowLayers, APicturesAlphaAloneSaysWhatItsNodesSay) {
  const std::vector<glm::vec3> by_nodes = one_traversal(*foliage(Writing::Unknown), 8);
  for (const Writing writing : {Writing::Plain, Writing::Mixed, Writing::Disguised})
    EXPECT_EQ(one_traversal(*foliage(writing), 8), by_nodes);
}

} // namespace
} // namespace lancer_test
