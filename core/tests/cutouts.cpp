// Surfaces that a picture cuts out: which are known as such, and that paths go past what is not there as if they had stopped.
#include "foliage.h"
#include "picture_lab.h"

#include "integrator/sample.h"

namespace lancer_test {
namespace {

Cutout cutout_of(Writing writing, float shines = 0.0f, void (*change)(Material &) = nullptr) {
  Description description;
  add_leaf_picture(description);
  add_foliage_materials(description, writing, shines);
  if (change)
    change(description.materials[0]);
  return make_cutouts(description.materials, description.images)[0];
}
Cutout changed(void (*change)(Material &)) { return cutout_of(Writing::Plain, 0.0f, change); }

TEST(Cutouts, KnownByTheirNodes) {
  const Cutout plain = cutout_of(Writing::Plain);
  EXPECT_TRUE(plain.alpha.known() && plain.painted && plain.may_end && plain.ends_with_alpha);
  EXPECT_EQ(plain.alpha.image, 0u);
  EXPECT_FALSE(plain.alpha.clamped);
  const Cutout mixed = cutout_of(Writing::Mixed);
  EXPECT_TRUE(mixed.alpha.known() && mixed.alpha.clamped && mixed.may_end && mixed.ends_with_alpha);
  // What the nodes say, at a place of a triangle; and more than that.
  const Cutout disguised = cutout_of(Writing::Disguised), anywhere = cutout_of(Writing::Unknown);
  EXPECT_TRUE(!disguised.alpha.known() && disguised.painted && disguised.may_end);
  EXPECT_TRUE(!anywhere.alpha.known() && !anywhere.painted && !anywhere.may_end);
}

TEST(Cutouts, SomethingMayBeLeftWhereAlphaIs0) {
  // The surface shines, scatters by another weight, or cuts a hole.
  EXPECT_FALSE(cutout_of(Writing::Plain, 1.0f).may_end);
  EXPECT_FALSE(changed([](Material &material) { material.lobes[0].weight.node = -1; }).may_end);
  EXPECT_FALSE(changed([](Material &material) { material.lobes[0].weight.node = 2; }).ends_with_alpha);
  EXPECT_FALSE(changed([](Material &material) { material.holdout.value = glm::vec3(1.0f); }).may_end);
}

TEST(Cutouts, OtherFormulas) {
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[5].option = LANCER_MATH_ADD; }).alpha.known());
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[5].flags = 1; }).alpha.known());
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[5].inputs[0].value = glm::vec3(0.5f); }).alpha.known());
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[2].option = LANCER_PROJECT_BOX; }).alpha.known());
  EXPECT_FALSE(changed([](Material &m) { m.program.nodes[2].option = LANCER_PROJECT_BOX; }).painted);
}

// As kernels look it up. One of the materials that they shade.
ColorPicture looked_up(Writing writing, void (*change)(Material &) = nullptr) {
  Description description;
  add_leaf_picture(description);
  add_foliage_materials(description, writing);
  if (change)
    change(description.materials[0]);
  std::vector<WideMaterial> wide(description.materials.size());
  wide[0].nodes = 1;
  return make_color_pictures(description.materials, wide, description.images)[0];
}

TEST(Cutouts, KernelsKnowThemByTheSameNodes) {
  for (const Writing writing : {Writing::Plain, Writing::Mixed}) {
    const ColorPicture leaf = looked_up(writing);
    EXPECT_TRUE(leaf.image && leaf.covers && leaf.clears);
    EXPECT_EQ(leaf.clamped, writing == Writing::Mixed);
    EXPECT_EQ(leaf.whole, 1.0f);
  }
  // A part of it that is always clear.
  const ColorPicture half = looked_up(Writing::Plain, [](Material &m) { m.program.nodes[5].inputs[0].value.x = 0.5f; });
  EXPECT_TRUE(half.image);
  EXPECT_EQ(half.whole, 0.5f);
  // What only the nodes know.
  EXPECT_FALSE(looked_up(Writing::Disguised).image);
  EXPECT_FALSE(looked_up(Writing::Mixed, [](Material &m) { m.program.nodes[4].inputs[1].value.x = 0.5f; }).image);
  EXPECT_FALSE(looked_up(Writing::Mixed, [](Material &m) { m.program.nodes[5].flags = 1; }).image);
  // Alpha as it is and clamped, and the alpha of something else.
  EXPECT_FALSE(looked_up(Writing::Mixed, [](Material &m) { m.lobes[0].weight.node = 3; }).image);
  EXPECT_FALSE(looked_up(Writing::Plain, [](Material &m) { m.program.nodes[3].inputs[0].node = 0; }).image);
}

struct Picture {
  std::vector<SampleResult> results;
  RayCounts counts;
};

Picture picture(const Scene &scene, const IntegratorSettings &settings, bool one_by_one = false) {
  constexpr uint32_t kPixels = 40;
  const Camera camera = camera_above(scene, kPixels);
  const auto integrator = make_integrator(scene, camera, settings);
  std::vector<SampleAddress> addresses;
  for (uint32_t i = 0; i < kPixels * kPixels; ++i)
    addresses.push_back({i % kPixels, i / kPixels, 0});
  Picture result;
  result.results.resize(addresses.size());
  std::vector<PathVertex> vertices;
  if (one_by_one)
    for (size_t i = 0; i < addresses.size(); ++i)
      integrator->run({&addresses[i], 1}, {&result.results[i], 1}, &vertices);
  else
    integrator->run(addresses, result.results, nullptr);
  result.counts = integrator->counts();
  return result;
}

std::vector<glm::vec3> radiance(const Picture &picture) {
  std::vector<glm::vec3> all;
  for (const SampleResult &result : picture.results)
    all.push_back(result.radiance);
  return all;
}

// The mean difference of two pictures of single samples, of 1600 pixels.
double mean_difference(const Picture &a, const Picture &b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.results.size(); ++i)
    for (int k = 0; k < 3; ++k)
      sum += std::abs(double(a.results[i].radiance[k]) - double(b.results[i].radiance[k])) / 3.0;
  return sum / double(a.results.size());
}

TEST(Cutouts, PathsGoPastWhatIsNotThereAsIfTheyHadStopped) {
  const auto stopping = foliage(Writing::Unknown);
  IntegratorSettings settings;
  settings.max_bounces = 3;
  for (const Writing writing : {Writing::Plain, Writing::Mixed, Writing::Disguised}) {
    const auto scene = foliage(writing);
    for (const uint32_t limit : {0u, 1u, 3u, 8u}) {
      settings.transparent_bounces = limit;
      const Picture fast = picture(*scene, settings), slow = picture(*stopping, settings);
      // A ray that starts again behind a layer meets the next within roundings of double. They reach a sample's floats as a
      // last digit here and there, 2^-24 of radiances up to 1, in each of some 2^6 operations.
      EXPECT_LE(mean_difference(fast, slow), 0x1p-18) << limit;
      EXPECT_EQ(fast.counts.camera, slow.counts.camera);
      if (limit == 8) {
        EXPECT_LT(fast.counts.bounce, slow.counts.bounce * 3 / 4);
      }
    }
  }
  settings.transparent_bounces = 0;
  const Picture none = picture(*stopping, settings);
  settings.transparent_bounces = 8;
  EXPECT_GT(mean_difference(none, picture(*stopping, settings)), 0.01);
}

TEST(Cutouts, AReplayedSampleIsTheSame) {
  IntegratorSettings settings;
  settings.max_bounces = 3;
  for (const Writing writing : {Writing::Plain, Writing::Mixed}) {
    const auto scene = foliage(writing);
    // Kernels look it up; where somebody wants to hear of the vertices the nodes do.
    ASSERT_TRUE(scene->pictures[0].image);
    EXPECT_EQ(radiance(picture(*scene, settings)), radiance(picture(*scene, settings, true)));
  }
}

TEST(Cutouts, PassesTellTheSameOfThem) {
  const auto plain = foliage(Writing::Plain), stopping = foliage(Writing::Unknown);
  IntegratorSettings settings;
  settings.max_bounces = 1;
  settings.passes |= 1u << LANCER_PASS_DEPTH | 1u << LANCER_PASS_OBJECT_INDEX | 1u << LANCER_PASS_POSITION;
  for (const float threshold : {0.0f, 0.5f}) {
    settings.alpha_threshold = threshold;
    const Picture fast = picture(*plain, settings), slow = picture(*stopping, settings);
    for (size_t i = 0; i < fast.results.size(); ++i) {
      const SampleResult &a = fast.results[i], &b = slow.results[i];
      ASSERT_EQ(a.object_index, b.object_index) << i;
      // The depth is made of as many roundings to float as there are layers, at most 9.
      ASSERT_NEAR(a.depth, b.depth, 9 * 0x1p-23f * b.depth) << i;
    }
    // The picture does not depend on what else is asked for.
    IntegratorSettings combined = settings;
    combined.passes = 1u << LANCER_PASS_COMBINED;
    EXPECT_EQ(radiance(fast), radiance(picture(*plain, combined)));
  }
}

} // namespace
} // namespace lancer_test
