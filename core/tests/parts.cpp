// Parts of a picture: any set of them, joined in any order, gives the bits of one session; other parts are refused.
#include "parts_lab.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <random>

namespace {

using namespace lancer_test;

// Returns parts of samples 0 ... end - 1 of all tiles, each of some tiles and samples, in random order.
std::vector<Bytes> random_parts(lancer_session session, uint32_t end, uint32_t seed) {
  std::mt19937 random(seed);
  const uint32_t tiles = tile_count(session);
  std::vector<Bytes> parts;
  for (uint32_t first = 0; first < end;) {
    const uint32_t count = std::min(end - first, 1 + uint32_t(random() % 9));
    std::vector<lancer_range> some[3];
    for (uint32_t tile = 0; tile < tiles; ++tile)
      some[random() % 3].push_back({tile, first, count});
    for (const auto &ranges : some)
      parts.push_back(rendered(session, ranges));
    first += count;
  }
  std::shuffle(parts.begin(), parts.end(), random);
  return parts;
}

class Parts : public testing::TestWithParam<uint32_t> {};

TEST_P(Parts, InAnyOrderGiveTheBitsOfOneSession) {
  const lancer_scene scene = named_scene();
  lancer_settings settings = settings_of_parts(GetParam());
  const Owned whole(scene, settings);
  ASSERT_EQ(lancer_session_render(whole.handle, 0, 27), LANCER_OK);
  ASSERT_EQ(finish(whole.handle), LANCER_OK);
  settings.threads = 1;
  settings.features = LANCER_FEATURES_ALL;
  const Owned worker(scene, settings);
  for (const uint32_t seed : {1u, 2u}) {
    const Owned joiner(0, settings);
    for (const Bytes &part : random_parts(worker.handle, 27, seed))
      ASSERT_EQ(import(joiner.handle, part), LANCER_OK) << lancer_last_error();
    expect_equal(whole.handle, joiner.handle);
  }
  lancer_scene_destroy(scene);
}

// A session without parts has tiles of another size.
TEST_P(Parts, HaveTheErrorOfASessionWithoutParts) {
  const lancer_scene scene = named_scene();
  lancer_settings settings = settings_of_parts(GetParam());
  const Owned worker(scene, settings), joiner(0, settings);
  settings.refines = 0;
  settings.tile_size = 32;
  const Owned whole(scene, settings);
  ASSERT_EQ(lancer_session_render(whole.handle, 0, 11), LANCER_OK);
  ASSERT_EQ(finish(whole.handle), LANCER_OK);
  for (const Bytes &part : random_parts(worker.handle, 11, 5))
    ASSERT_EQ(import(joiner.handle, part), LANCER_OK) << lancer_last_error();
  expect_equal_pictures(whole.handle, joiner.handle);
  lancer_scene_destroy(scene);
}

INSTANTIATE_TEST_SUITE_P(AllIntegrators, Parts, testing::Values(LANCER_PATH, LANCER_CLASSIC, LANCER_NORMALS));

TEST(PartsOfSplits, AreDecidedAsOneSessionDoes) {
  const lancer_scene scene = named_scene();
  lancer_settings settings = settings_of_parts();
  settings.split_lights = settings.split_paths = 0;
  const Owned whole(scene, settings), decider(scene, settings);
  ASSERT_EQ(lancer_session_render(whole.handle, 0, 1), LANCER_OK);
  ASSERT_EQ(finish(whole.handle), LANCER_OK);
  ASSERT_EQ(lancer_session_decide(decider.handle), LANCER_OK);
  ASSERT_EQ(finish(decider.handle), LANCER_OK);
  lancer_statistics decided, used;
  lancer_session_statistics(decider.handle, &decided);
  lancer_session_statistics(whole.handle, &used);
  EXPECT_EQ(decided.samples, 0u);
  EXPECT_GT(decided.split_lights, 0u);
  EXPECT_EQ(decided.split_lights, used.split_lights);
  EXPECT_EQ(decided.split_paths, used.split_paths);
  // A search that is cancelled leaves the numbers unknown.
  const Owned other(scene, settings);
  ASSERT_EQ(lancer_session_decide(other.handle), LANCER_OK);
  lancer_session_cancel(other.handle);
  const lancer_status status = finish(other.handle);
  lancer_session_statistics(other.handle, &decided);
  EXPECT_EQ(decided.split_lights > 0, status == LANCER_OK);
  lancer_scene_destroy(scene);
}

TEST(PartsOfSplits, AreTakenOver) {
  const lancer_scene scene = named_scene();
  lancer_settings settings = settings_of_parts(), told = settings;
  settings.split_lights = settings.split_paths = 0;
  told.split_lights = 2;
  told.split_paths = 3;
  const Owned whole(scene, told), worker(scene, told), joiner(0, settings), continued(scene, settings);
  ASSERT_EQ(lancer_session_render(whole.handle, 0, 8), LANCER_OK);
  ASSERT_EQ(finish(whole.handle), LANCER_OK);
  for (const Bytes &part : random_parts(worker.handle, 8, 3))
    ASSERT_EQ(import(joiner.handle, part), LANCER_OK) << lancer_last_error();
  expect_equal(whole.handle, joiner.handle);
  // The session that continues uses the part's numbers and searches for none.
  std::vector<lancer_range> all;
  for (uint32_t tile = 0; tile < tile_count(worker.handle); ++tile)
    all.push_back({tile, 0, 4});
  ASSERT_EQ(import(continued.handle, rendered(worker.handle, all)), LANCER_OK) << lancer_last_error();
  ASSERT_EQ(lancer_session_render(continued.handle, 4, 4), LANCER_OK);
  ASSERT_EQ(finish(continued.handle), LANCER_OK);
  expect_equal(whole.handle, continued.handle);
  // Another number of paths is another picture.
  told.split_paths = 4;
  const Owned other(scene, told);
  EXPECT_EQ(import(joiner.handle, rendered(other.handle, {{0, 8, 1}})), LANCER_ERROR_ARGUMENT);
  EXPECT_NE(std::string(lancer_last_error()).find("4 paths"), std::string::npos) << lancer_last_error();
  lancer_scene_destroy(scene);
}

TEST(PartsOfRounds, RefineLikeOneSession) {
  const lancer_scene scene = named_scene();
  const lancer_settings settings = settings_of_parts();
  const Owned whole(scene, settings), worker(scene, settings), joiner(0, settings);
  ASSERT_EQ(lancer_session_render(whole.handle, 0, 4), LANCER_OK);
  ASSERT_EQ(finish(whole.handle), LANCER_OK);
  std::vector<lancer_range> all;
  for (uint32_t tile = 0; tile < tile_count(worker.handle); ++tile)
    all.push_back({tile, 0, 4});
  ASSERT_EQ(import(joiner.handle, rendered(worker.handle, all)), LANCER_OK) << lancer_last_error();
  bool uneven = false;
  for (int round = 0; round < 3; ++round) {
    std::vector<lancer_range> ranges(all.size());
    uint32_t count = 0;
    lancer_error error;
    lancer_session_error(joiner.handle, 0.95, &error);
    const double target = 0.9 * (error.high + error.cannot_exclude);
    ASSERT_EQ(lancer_session_plan(joiner.handle, target, 0.95, uint32_t(ranges.size()), ranges.data(), &count), LANCER_OK);
    ASSERT_GT(count, 0u);
    ranges.resize(count);
    uneven |= count < all.size();
    ASSERT_EQ(lancer_session_refine(whole.handle, target, 0.95), LANCER_OK);
    ASSERT_EQ(finish(whole.handle), LANCER_OK);
    // The round's parts come in reverse order.
    const auto half = ranges.begin() + count / 2;
    ASSERT_EQ(import(joiner.handle, rendered(worker.handle, {half, ranges.end()})), LANCER_OK) << lancer_last_error();
    ASSERT_EQ(import(joiner.handle, rendered(worker.handle, {ranges.begin(), half})), LANCER_OK) << lancer_last_error();
    expect_equal(whole.handle, joiner.handle);
  }
  EXPECT_TRUE(uneven) << "the rounds doubled all tiles, which tests no choice";
  lancer_scene_destroy(scene);
}

TEST(PartsOfSessions, LetASessionContinue) {
  const lancer_scene scene = named_scene();
  const lancer_settings settings = settings_of_parts();
  const Owned whole(scene, settings), first(scene, settings), second(scene, settings);
  ASSERT_EQ(lancer_session_render(whole.handle, 0, 12), LANCER_OK);
  ASSERT_EQ(finish(whole.handle), LANCER_OK);
  ASSERT_EQ(lancer_session_render(first.handle, 0, 5), LANCER_OK);
  ASSERT_EQ(finish(first.handle), LANCER_OK);
  ASSERT_EQ(import(second.handle, exported(first.handle)), LANCER_OK) << lancer_last_error();
  ASSERT_EQ(lancer_session_render(second.handle, 5, 7), LANCER_OK) << lancer_last_error();
  ASSERT_EQ(finish(second.handle), LANCER_OK);
  expect_equal(whole.handle, second.handle);
  lancer_scene_destroy(scene);
}

TEST(PartsOfRanges, AreUnknownUntilTheyAreWhole) {
  const lancer_scene scene = named_scene();
  const lancer_settings settings = settings_of_parts();
  const Owned worker(scene, settings);
  std::vector<lancer_range> all;
  for (uint32_t tile = 0; tile < tile_count(worker.handle); ++tile)
    all.push_back({tile, 6, 4});
  rendered(worker.handle, all);
  // The picture is the mean of the samples that are there; its error and the values of sample 0 are unknown.
  lancer_error error;
  lancer_session_error(worker.handle, 0.95, &error);
  EXPECT_EQ(error.error, std::numeric_limits<double>::infinity());
  EXPECT_EQ(read(worker.handle, LANCER_PASS_DEPTH), std::vector<float>(kWidth * kHeight, 1e10f));
  const std::vector<float> picture = read(worker.handle, LANCER_PASS_COMBINED);
  EXPECT_GT(*std::ranges::max_element(picture), 0.0f);
  EXPECT_EQ(lancer_session_render(worker.handle, 10, 1), LANCER_ERROR_STATE);
  lancer_range ranges[2] = {{0, 10, 1}, {0, 11, 1}};
  EXPECT_EQ(lancer_session_render_ranges(worker.handle, 2, ranges), LANCER_ERROR_ARGUMENT) << "two ranges of a tile";
  ranges[0].first = 11;
  EXPECT_EQ(lancer_session_render_ranges(worker.handle, 1, ranges), LANCER_ERROR_STATE) << "a gap";
  ranges[0] = {1000000, 0, 1};
  EXPECT_EQ(lancer_session_render_ranges(worker.handle, 1, ranges), LANCER_ERROR_ARGUMENT) << "no such tile";
  ranges[0] = {0, 10, 1};
  EXPECT_EQ(lancer_session_render_ranges(worker.handle, 1, ranges), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(finish(worker.handle), LANCER_OK);
  lancer_scene_destroy(scene);
}

TEST(PartsOfRanges, StartAgainAfterACancel) {
  const lancer_scene scene = named_scene();
  const lancer_settings settings = settings_of_parts();
  const Owned worker(scene, settings), fresh(scene, settings);
  const std::vector<lancer_range> range = {{0, 3, 5}, {3, 0, 2}};
  for (const auto &end : {lancer_session_cancel, lancer_session_stop}) {
    const lancer_range endless = {1, 0, 1u << 30};
    ASSERT_EQ(lancer_session_clear(worker.handle), LANCER_OK);
    ASSERT_EQ(lancer_session_render_ranges(worker.handle, 1, &endless), LANCER_OK);
    EXPECT_EQ(lancer_session_clear(worker.handle), LANCER_ERROR_STATE) << "while rendering";
    EXPECT_EQ(lancer_session_export(worker.handle, nullptr, 0, nullptr), LANCER_ERROR_STATE) << "while rendering";
    end(worker.handle);
    EXPECT_EQ(finish(worker.handle), LANCER_CANCELLED);
    EXPECT_EQ(rendered(worker.handle, range), rendered(fresh.handle, range));
  }
  lancer_scene_destroy(scene);
}

// Parts that do not fit.
class Refused : public testing::Test {
protected:
  lancer_scene scene = named_scene();
  lancer_settings settings = settings_of_parts();
  Owned worker{scene, settings};
  Bytes part = rendered(worker.handle, {{0, 0, 4}, {2, 0, 6}});

  ~Refused() override { lancer_scene_destroy(scene); }

  // Expects that a session of these settings refuses a part with this word, and keeps its samples.
  void expect(const lancer_settings &other, const Bytes &refused, const std::string &word) {
    const Owned joiner(0, other);
    Owned source(scene, other);
    ASSERT_EQ(import(joiner.handle, rendered(source.handle, {{2, 0, 2}, {4, 0, 3}})), LANCER_OK) << lancer_last_error();
    const Bytes before = exported(joiner.handle);
    EXPECT_EQ(import(joiner.handle, refused), LANCER_ERROR_ARGUMENT) << word;
    const std::string told = lancer_last_error();
    EXPECT_EQ(told.rfind("part: ", 0), 0u) << told;
    EXPECT_NE(told.find(word), std::string::npos) << told << " lacks: " << word;
    EXPECT_EQ(before, exported(joiner.handle)) << word;
  }
};

TEST_F(Refused, IfItOverlaps) { expect(settings, part, "samples 0 to 1 of tile 2"); }

TEST_F(Refused, IfItIsDamaged) {
  for (const size_t at : {size_t(30), part.size() / 2, part.size() - 1}) {
    Bytes damaged = part;
    damaged[at] ^= 1;
    expect(settings, damaged, "damaged");
  }
  expect(settings, Bytes(100, 7), "no part");
}

TEST_F(Refused, IfItIsIncomplete) {
  for (const size_t size : {size_t(9), size_t(200), part.size() - 1})
    expect(settings, Bytes(part.begin(), part.begin() + ptrdiff_t(size)), "incomplete");
}

TEST_F(Refused, IfItIsOfAnotherPicture) {
  lancer_settings other = settings;
  other.seed = 3;
  expect(other, part, "seed is 0");
  other = settings;
  other.max_bounces = 5;
  expect(other, part, "max_bounces is 6");
  other = settings;
  other.passes = 1;
  expect(other, part, "passes");
  other = settings;
  other.split_paths = 4;
  expect(other, part, "1 paths");
}

TEST_F(Refused, IfItIsOfAnotherSceneOrCamera) {
  const lancer_scene renamed = make_scene();
  uint8_t digest[32] = {9};
  lancer_scene_set_digest(renamed, digest);
  const Owned elsewhere(renamed, settings);
  expect(settings, rendered(elsewhere.handle, {{0, 0, 1}}), "another scene");
  lancer_scene_destroy(renamed);
  lancer_camera camera = make_camera(kWidth, kHeight);
  camera.lens_radius = 0.1;
  lancer_session session = 0;
  ASSERT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK);
  expect(settings, rendered(session, {{0, 0, 1}}), "another camera");
  lancer_session_destroy(session);
  camera = make_camera(kWidth + 1, kHeight);
  ASSERT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK);
  expect(settings, rendered(session, {{0, 0, 1}}), "41 x 23 pixels");
  lancer_session_destroy(session);
}

TEST_F(Refused, IfTheSessionHasNoParts) {
  lancer_settings plain = settings;
  plain.refines = 0;
  const Owned session(scene, plain);
  EXPECT_EQ(import(session.handle, part), LANCER_ERROR_STATE);
  EXPECT_EQ(lancer_session_export(session.handle, nullptr, 0, nullptr), LANCER_ERROR_STATE);
  const lancer_scene nameless = make_scene();
  const Owned other(nameless, settings);
  EXPECT_EQ(import(other.handle, part), LANCER_ERROR_STATE);
  EXPECT_NE(std::string(lancer_last_error()).find("digest"), std::string::npos);
  lancer_scene_destroy(nameless);
}

TEST(Joiner, RendersNothing) {
  const Owned joiner(0, settings_of_parts());
  const lancer_range range = {0, 0, 1};
  float rgba[4];
  EXPECT_EQ(lancer_session_render(joiner.handle, 0, 1), LANCER_ERROR_STATE);
  EXPECT_EQ(lancer_session_render_ranges(joiner.handle, 1, &range), LANCER_ERROR_STATE);
  EXPECT_EQ(lancer_session_refine(joiner.handle, 0.1, 0.95), LANCER_ERROR_STATE);
  EXPECT_EQ(lancer_session_decide(joiner.handle), LANCER_ERROR_STATE);
  EXPECT_EQ(lancer_debug_sample(joiner.handle, 0, 0, 0, rgba, nullptr, 0, nullptr), LANCER_ERROR_STATE);
  lancer_statistics statistics;
  EXPECT_EQ(lancer_session_statistics(joiner.handle, &statistics), LANCER_OK);
  EXPECT_EQ(statistics.samples, 0u);
}

TEST(PartOf, IsDescribed) {
  const lancer_scene scene = named_scene();
  const lancer_settings settings = settings_of_parts();
  const Owned worker(scene, settings);
  const Bytes part = rendered(worker.handle, {{0, 3, 4}, {2, 5, 6}});
  lancer_part described;
  ASSERT_EQ(lancer_part_describe(part.data(), part.size(), &described), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(std::memcmp(described.digest, kDigest, sizeof kDigest), 0);
  EXPECT_STREQ(described.release, lancer_version());
  EXPECT_EQ(described.camera.region_width, kWidth);
  EXPECT_EQ(described.settings.max_bounces, settings.max_bounces);
  EXPECT_EQ(described.split_lights, 2u);
  EXPECT_EQ(described.tiles, 2u);
  EXPECT_EQ(described.first, 3u);
  EXPECT_EQ(described.end, 11u);
  // Tiles of 128 pixels.
  EXPECT_EQ(described.samples, 128u * 10u);
  lancer_scene_destroy(scene);
}

} // namespace
