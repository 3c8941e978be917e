// Films whose parts are joined: without memory they stay as they are, and the largest light does not keep parts from fitting.
#include "allocations.h"

#include "render/parts.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

namespace lancer {
namespace {

using lancer_test::Allocations;
using Bytes = std::vector<std::byte>;

constexpr uint32_t kSide = 3, kPasses = bit(Pass::Combined) | bit(Pass::Depth) | bit(Pass::Halves);

// The film of a picture of one square, which is two tiles of 5 and 4 pixels.
struct Picture {
  Identity identity;
  Film film{kSide, kSide, 16, kPasses, true};

  Picture() { identity.camera.region_width = identity.camera.region_height = kSide; }

  // Adds samples that differ from each other to a tile, and drops one of them.
  void add(uint32_t tile, uint32_t first, uint32_t count, float light = 1.0f) {
    Film::Tile &to = film.tile(tile);
    if (to.count == 0)
      Film::clear(to, first);
    const glm::uvec2 place = to.place(1);
    film.drop(to, {place.x, place.y, first});
    for (uint32_t s = first; s < first + count; ++s) {
      SampleResult result(true);
      result.radiance = glm::vec3(s % 2 ? -light : light / float(s + 1));
      result.depth = float(s + 2);
      film.add(to, 1, std::vector<SampleResult>(to.pixels(), result));
    }
  }
  Bytes part() const {
    Totals totals;
    totals.rays.camera = 7;
    Energy::remove(totals.energy.clipped, 0.5f);
    Bytes bytes(part_size(film));
    write_part(film, identity, Splits{}, totals, bytes);
    return bytes;
  }
};

// The film has samples before, among, and after those of the part, so that sums are joined with the ones around them.
TEST(PartsWithoutMemory, LeaveTheFilmAsItIs) {
  Picture other;
  other.add(0, 0, 3);
  other.add(1, 4, 2);
  const Bytes more = other.part();
  Picture gaps;
  gaps.add(0, 8, 5);
  const Bytes again = gaps.part();
  bool failed = true;
  uint64_t allowed = 0;
  for (; failed; ++allowed) {
    SCOPED_TRACE("allocations: " + std::to_string(allowed));
    Picture picture;
    picture.add(0, 3, 2);
    picture.add(1, 2, 2);
    const Part first(more), second(again);
    const Bytes before = picture.part();
    failed = false;
    try {
      const Allocations allocations(allowed);
      first.add_to(picture.film, {});
    } catch (const std::bad_alloc &) {
      failed = true;
    }
    if (failed) {
      EXPECT_EQ(before, picture.part());
      first.add_to(picture.film, {});
    }
    second.add_to(picture.film, {});
    Picture whole;
    whole.add(0, 0, 3);
    whole.add(0, 3, 2);
    Part(again).add_to(whole.film, {});
    whole.add(1, 2, 2);
    whole.add(1, 4, 2);
    EXPECT_EQ(picture.part(), whole.part());
  }
  // At least the tiles, their sums and their pixels were refused once.
  EXPECT_GT(allowed, 8u);
}

TEST(PartsOfTheLargestLight, Fit) {
  Picture bright;
  bright.add(0, 0, 2, std::numeric_limits<float>::max());
  bright.add(1, 0, 3, -std::numeric_limits<float>::max());
  const Bytes part = bright.part();
  Picture joined;
  EXPECT_NO_THROW(Part(part).add_to(joined.film, {}));
  EXPECT_EQ(part, joined.part());
}

} // namespace
} // namespace lancer
