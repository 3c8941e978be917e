// Parts with checksums that fit and numbers that no session writes: refused as a whole, with a sentence that says why.
#include "parts_made.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace {

using namespace lancer_test;

constexpr uint32_t kMost = 1u << 31;
constexpr int64_t kMostDigit = int64_t(1) << 60;
constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

MadeTile of_nodes(std::vector<MadeTile::Node> nodes, uint32_t tile = 0) {
  MadeTile made;
  made.tile = tile;
  made.nodes = std::move(nodes);
  return made;
}

// Expects that a joiner with samples 0 and 1 of tile 1 refuses the part with these words, and keeps its samples.
void expect_refused(const Made &made, const std::string &words) {
  const MadeJoiner joiner;
  ASSERT_EQ(import(joiner.handle, Made({of_nodes({{0, 1, 1.0}}, 1)}).bytes()), LANCER_OK) << lancer_last_error();
  const Bytes before = exported(joiner.handle);
  EXPECT_EQ(import(joiner.handle, made.bytes()), LANCER_ERROR_ARGUMENT) << words;
  const std::string told = lancer_last_error();
  EXPECT_EQ(told.rfind("part: ", 0), 0u) << told;
  EXPECT_NE(told.find(words), std::string::npos) << told << " lacks: " << words;
  EXPECT_EQ(before, exported(joiner.handle)) << words;
}

// Changes the part of samples 0 and 1 of tile 0.
void expect_refused(const std::function<void(Made &)> &change, const std::string &words) {
  Made made;
  change(made);
  expect_refused(made, words);
}

TEST(PartMade, IsThePartOfASessionThatJoinsIt) {
  MadeTile tile = of_nodes({{0, 2, 4.0}, {4, 1, -2.0}, {9, 0, 0.5}});
  tile.dropped = {1, 0, 0, 2};
  tile.first_dropped[0] = 2;
  const Bytes part = Made({tile, of_nodes({{0, 31, 3.0}}, 1)}).bytes();
  const MadeJoiner joiner;
  ASSERT_EQ(import(joiner.handle, part), LANCER_OK) << lancer_last_error();
  Bytes again = exported(joiner.handle);
  // Features, threads and tile size are 0 in a part of a session.
  Made told({tile, of_nodes({{0, 31, 3.0}}, 1)});
  told.description.settings.threads = 0;
  EXPECT_EQ(told.bytes(), again);
  lancer_statistics statistics;
  lancer_session_statistics(joiner.handle, &statistics);
  EXPECT_EQ(statistics.invalid_samples, 3u);
  EXPECT_EQ(statistics.invalid_x, 2u);
  // Dropped samples of several parts are counted together.
  MadeTile more = of_nodes({{6, 1, 0.0}});
  more.dropped = {0, 0, 0, 5};
  more.first_dropped[2] = 6;
  ASSERT_EQ(import(joiner.handle, Made({more}).bytes()), LANCER_OK) << lancer_last_error();
  lancer_session_statistics(joiner.handle, &statistics);
  EXPECT_EQ(statistics.invalid_samples, 8u);
  EXPECT_EQ(statistics.invalid_x, 2u);
}

TEST(PartsWithHostileTiles, AreRefused) {
  const auto of_tile = [](const std::function<void(MadeTile &)> &change) { return [=](Made &made) { change(made.tiles[0]); }; };
  const std::string tiles = "its tiles are out of order", sums = "the sums of tile 0 are out of order";
  expect_refused(of_tile([](MadeTile &tile) { tile.tile = 2; }), tiles);
  expect_refused(of_tile([](MadeTile &tile) { tile.tile = ~0u; }), tiles);
  expect_refused(Made({of_nodes({{8, 0, 1.0}}, 1), of_nodes({{8, 0, 1.0}}, 0)}), tiles);
  expect_refused(Made({of_nodes({{8, 0, 1.0}}), of_nodes({{8, 0, 1.0}})}), tiles);
  expect_refused(of_tile([](MadeTile &tile) { tile.told_nodes = 0; }), tiles);
  expect_refused(of_tile([](MadeTile &tile) { tile.told_nodes = ~0u; }), "its size fits no tiles");
  expect_refused(of_tile([](MadeTile &tile) { tile.told_dropped = ~0u; }), tiles);
  expect_refused(of_tile([](MadeTile &tile) { tile.told_first = 2; }), tiles);
  expect_refused(of_tile([](MadeTile &tile) { tile.told_first = 0; }), "sample 0 of tile 0 is incomplete");
  for (const std::vector<MadeTile::Node> &nodes : std::vector<std::vector<MadeTile::Node>>{
           {{1, 1, 1.0}},              // no multiple of its size
           {{0, 2, 1.0}, {2, 1, 1.0}}, // overlaps
           {{4, 1, 1.0}, {2, 1, 1.0}}, // falls
           {{0, 32, 1.0}},             // too large a number of samples for a shift
           {{kMost, 0, 1.0}},          // beyond the last sample
           {{kMost, 31, 1.0}},         // ends at 2^32
           {{0, 31, 1.0}, {kMost - 1, 0, 1.0}},
       }) {
    Made made;
    made.tiles = {of_nodes(nodes)};
    made.tiles[0].tell();
    expect_refused(made, sums);
  }
}

TEST(PartsWithHostileDescriptions, AreRefused) {
  const std::string other = "description";
  expect_refused([](Made &made) { ++made.description.tiles; }, "1 tiles of 2");
  expect_refused([](Made &made) { ++made.description.samples; }, other);
  expect_refused([](Made &made) { made.description.samples = ~uint64_t(0); }, other);
  expect_refused([](Made &made) { made.description.first = 1; }, other);
  expect_refused([](Made &made) { made.description.end = 3; }, other);
  for (const uint32_t splits : {0u, 17u, ~0u}) {
    expect_refused([=](Made &made) { made.description.split_lights = splits; }, std::to_string(splits) + " lights");
    expect_refused([=](Made &made) { made.description.split_paths = splits; }, std::to_string(splits) + " paths");
  }
  expect_refused([](Made &made) { made.description.release[0] = '9'; }, "it is of Lancer 9");
  expect_refused([](Made &made) { std::memset(made.description.release, 0xff, sizeof made.description.release); },
                 "it is of Lancer ????????????????, the session of " + std::string(lancer_version()));
  expect_refused([](Made &made) { made.description.camera.lens_radius = double(kNan); }, "another camera");
  expect_refused([](Made &made) { made.description.camera.matrix[3] = double(kInfinity); }, "another camera");
  expect_refused([](Made &made) { made.description.camera.region_width = ~0u; }, "4294967295 x 5 pixels");
  expect_refused([](Made &made) { made.description.camera.region_height = 0; }, "6 x 0 pixels");
  expect_refused([](Made &made) { made.description.settings.filter_width = kNan; }, "filter_width is nan");
  expect_refused([](Made &made) { made.description.settings.mist_depth = -kInfinity; }, "mist_depth is -inf");
  expect_refused([](Made &made) { made.description.settings.max_bounces = ~0u; }, "max_bounces is 4294967295");
  expect_refused([](Made &made) { made.description.settings.integrator = 77; }, "integrator is 77");
  expect_refused([](Made &made) { made.description.settings.passes |= 1u << LANCER_PASS_COUNT; },
                 "passes is " + std::to_string(made_settings().passes | 1u << LANCER_PASS_COUNT));
  expect_refused([](Made &made) { made.description.settings.passes = ~0u; }, "passes is 4294967295");
  // They are described as they are, and make no session.
  Made made;
  made.description.settings.filter_width = kNan;
  lancer_part described;
  const Bytes part = made.bytes();
  ASSERT_EQ(lancer_part_describe(part.data(), part.size(), &described), LANCER_OK) << lancer_last_error();
  lancer_session session = 0;
  EXPECT_EQ(lancer_session_create_joiner(kDigest, &described.camera, &described.settings, &session), LANCER_ERROR_ARGUMENT);
}

TEST(PartsWithHostileTotals, AreRefused) {
  const std::string words = "its sums of rays or light are no numbers";
  for (const int64_t last :
       {std::numeric_limits<int64_t>::min(), std::numeric_limits<int64_t>::max(), kMostDigit + 1, -kMostDigit - 1})
    for (uint32_t sum = 0; sum < 10; ++sum)
      expect_refused([=](Made &made) { made.digits[sum][31] = last; }, words);
  for (const int64_t digit : {int64_t(-1), int64_t(256)})
    expect_refused([=](Made &made) { made.digits[2][30] = digit; }, words);
  // Clamping and limits remove absolute values; the others are sums of squares.
  for (const uint32_t sum : {0, 1, 2, 3, 7, 9})
    expect_refused([=](Made &made) { made.digits[sum][31] = -1; }, words);
  for (uint32_t count = 0; count < 4; ++count)
    expect_refused([=](Made &made) { made.counts[count] = ~uint64_t(0); }, words);
}

// Each part is possible alone.
TEST(PartsWithHostileTotals, AreRefusedTogether) {
  const auto last_digit = [](Made &made) { made.digits[4][31] = -kMostDigit; };
  const auto rays = [](Made &made) { made.counts[3] = uint64_t(1) << 60; };
  for (const std::function<void(Made &)> &change : std::vector<std::function<void(Made &)>>{last_digit, rays}) {
    const MadeJoiner joiner;
    Made first, second({of_nodes({{0, 1, 1.0}}, 1)}), empty(std::vector<MadeTile>{});
    for (Made *made : {&first, &second, &empty})
      change(*made);
    ASSERT_EQ(import(joiner.handle, first.bytes()), LANCER_OK) << lancer_last_error();
    const Bytes before = exported(joiner.handle);
    for (const Made &made : {second, empty}) {
      EXPECT_EQ(import(joiner.handle, made.bytes()), LANCER_ERROR_ARGUMENT);
      EXPECT_NE(std::string(lancer_last_error()).find("together with the session's"), std::string::npos) << lancer_last_error();
    }
    EXPECT_EQ(before, exported(joiner.handle));
  }
}

// A pixel's sum is one of as many finite floats as it has samples.
TEST(PartsWithHostileSums, AreRefused) {
  const double most = double(std::numeric_limits<float>::max()), least = double(std::numeric_limits<float>::denorm_min());
  for (const double sum : {1e300, -1e300, 2.0000001 * most, 0.5 * least, -1e-300, std::numeric_limits<double>::denorm_min()})
    expect_refused(Made({of_nodes({{0, 1, sum}})}), "a sum of tile 0 is no sum of its samples");
  for (const double sum : {double(kInfinity), double(kNan)})
    expect_refused(Made({of_nodes({{0, 1, sum}})}), "a number is not finite");
  for (float MadeTile::*value : {&MadeTile::difference, &MadeTile::brightest, &MadeTile::depth})
    for (const float number : {kInfinity, -kInfinity, kNan})
      expect_refused([=](Made &made) { made.tiles[0].*value = number; }, "a number is not finite");
  expect_refused([](Made &made) { made.tiles[0].brightest = -1.0f; }, "a largest luminance of tile 0 is negative");
}

// The largest numbers that are allowed keep the picture and its errors finite, or unknown.
TEST(PartsWithExtremeSums, AreReadAsNumbers) {
  const double most = double(std::numeric_limits<float>::max()), least = double(std::numeric_limits<float>::denorm_min());
  for (const double sum : {2.0 * most, -2.0 * most, least, -least, 0.0})
    for (const double other : {2.0 * most, -2.0 * most, least, 1.0, 0.0}) {
      const MadeJoiner joiner;
      MadeTile tiles[2] = {of_nodes({{0, 1, sum}}), of_nodes({{0, 1, other}}, 1)};
      tiles[0].difference = std::numeric_limits<float>::max();
      tiles[0].brightest = tiles[1].depth = std::numeric_limits<float>::max();
      ASSERT_EQ(import(joiner.handle, Made({tiles[0], tiles[1]}).bytes()), LANCER_OK) << lancer_last_error();
      std::vector<float> picture(kMadeWidth * kMadeHeight * 4), bars(kMadeWidth * kMadeHeight);
      ASSERT_EQ(lancer_session_read(joiner.handle, LANCER_PASS_COMBINED, picture.data(), picture.size()), LANCER_OK);
      EXPECT_TRUE(std::ranges::all_of(picture, [](float value) { return std::isfinite(value); }));
      ASSERT_EQ(lancer_session_read(joiner.handle, LANCER_PASS_ERROR, bars.data(), bars.size()), LANCER_OK);
      EXPECT_TRUE(std::ranges::all_of(bars, [](float value) { return value >= 0.0f; }));
      lancer_error error;
      ASSERT_EQ(lancer_session_error(joiner.handle, 0.95, &error), LANCER_OK);
      EXPECT_LE(error.low, error.error) << sum << " " << other;
      EXPECT_LE(error.error, error.high);
      EXPECT_GE(error.cannot_exclude, 0.0);
    }
}

TEST(PartsWithHostileDroppedSamples, AreRefused) {
  const auto of_dropped = [](std::vector<uint64_t> dropped, uint32_t x, uint32_t y, uint32_t sample) {
    MadeTile tile = of_nodes({{0, 1, 1.0}, {8, 0, 1.0}});
    tile.dropped = std::move(dropped);
    std::copy_n(std::array{x, y, sample}.begin(), 3, tile.first_dropped);
    return Made({tile});
  };
  const std::string words = "the dropped samples of tile 0 are not among its samples";
  {
    // Sample 8 has the bit width 4.
    const MadeJoiner joiner;
    EXPECT_EQ(import(joiner.handle, of_dropped({15, 15, 0, 0, 15}, 0, 0, 0).bytes()), LANCER_OK) << lancer_last_error();
  }
  expect_refused(of_dropped({16}, 0, 0, 0), words);
  expect_refused(of_dropped({0, ~uint64_t(0)}, 0, 0, 1), words);
  expect_refused(of_dropped({0, 0, 1}, 0, 0, 2), words);    // a sample that is missing
  expect_refused(of_dropped({1, 0}, 0, 0, 0), words);       // ends with none
  expect_refused(of_dropped({0, 1}, 0, 0, 0), words);       // the first one has another width
  expect_refused(of_dropped({1}, 1, 0, 0), words);          // a pixel of the other tile
  expect_refused(of_dropped({1}, kMadeWidth, 0, 0), words); // outside the picture
  expect_refused(of_dropped({1}, 0, ~0u, 0), words);
  expect_refused(of_dropped({0, 0, 0, 0, 1}, 0, 0, 9), words); // not the sample that is there
  expect_refused(of_dropped(std::vector<uint64_t>(33, 1), 0, 0, 0), "its tiles are out of order");
}

TEST(PartsOfAllSamples, AreTheLastThatATileTakes) {
  const MadeJoiner joiner;
  ASSERT_EQ(import(joiner.handle, Made({of_nodes({{0, 30, 1.0}}), of_nodes({{0, 31, 3.0}}, 1)}).bytes()), LANCER_OK);
  ASSERT_EQ(import(joiner.handle, Made({of_nodes({{1u << 30, 30, 2.0}})}).bytes()), LANCER_OK) << lancer_last_error();
  lancer_error error;
  lancer_session_error(joiner.handle, 0.95, &error);
  EXPECT_EQ(error.least_samples, kMost);
  EXPECT_EQ(error.most_samples, kMost);
  EXPECT_TRUE(std::isfinite(error.error));
  float picture[kMadeWidth * kMadeHeight * 4];
  ASSERT_EQ(lancer_session_read(joiner.handle, LANCER_PASS_COMBINED, picture, std::size(picture)), LANCER_OK);
  EXPECT_EQ(picture[0], float(std::ldexp(3.0, -31)));
  uint32_t count = 7;
  ASSERT_EQ(lancer_session_plan(joiner.handle, 0.0, 0.95, 0, nullptr, &count), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(count, 0u) << "a tile would have more samples than the settings plan";
  EXPECT_EQ(import(joiner.handle, Made({of_nodes({{kMost - 1, 0, 1.0}})}).bytes()), LANCER_ERROR_ARGUMENT);
}

// The samples of many parts may have gaps.
TEST(PartsWithGaps, AreJoinedInAnyNumber) {
  constexpr uint32_t kSums = 200;
  const MadeJoiner joiner, other;
  for (uint32_t i = 0; i < kSums; ++i)
    ASSERT_EQ(import(joiner.handle, Made({of_nodes({{2 * ((i * 7) % kSums), 0, 1.0}})}).bytes()), LANCER_OK) << i;
  const Bytes part = exported(joiner.handle);
  ASSERT_EQ(import(other.handle, part), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(part, exported(other.handle));
  EXPECT_EQ(import(other.handle, Made({of_nodes({{20, 2, 1.0}})}).bytes()), LANCER_ERROR_ARGUMENT);
  EXPECT_NE(std::string(lancer_last_error()).find("sample 20 of tile 0"), std::string::npos) << lancer_last_error();
}

} // namespace
