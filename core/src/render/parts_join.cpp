// The reading of parts: all checks, then the sums.
#include "render/checksum.h"
#include "render/part_format.h"
#include "render/parts.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace lancer {

namespace {

// Samples of a pixel, and the bit width of the last one's number.
constexpr uint64_t kMostSamples = uint64_t(1) << 31;
constexpr uint32_t kMostWidths = 32;

[[noreturn]] void refuse_damaged(const std::string &why) { refuse_part("it is damaged: " + why); }

class Reader {
public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  void read(void *to, size_t size) {
    if (size > left())
      refuse_damaged("its size fits no tiles");
    if (size > 0)
      std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }
  template <class Number> Number number() {
    Number value;
    read(&value, sizeof value);
    return value;
  }
  // Reads count numbers, which must be finite.
  template <class Number> void numbers(std::vector<Number> &values, size_t count) {
    if (count > left() / sizeof(Number))
      refuse_damaged("its size fits no tiles");
    values.resize(count);
    read(values.data(), count * sizeof(Number));
    if constexpr (std::is_floating_point_v<Number>)
      if (!std::ranges::all_of(values, [](Number value) { return std::isfinite(value); }))
        refuse_damaged("a number is not finite");
  }
  void skip(size_t size) { at_ += size; }
  size_t left() const { return bytes_.size() - at_; }

private:
  std::span<const std::byte> bytes_;
  size_t at_ = 0;
};

std::string samples_of(uint64_t start, uint64_t end) {
  return end - start == 1 ? "sample " + std::to_string(start)
                          : "samples " + std::to_string(start) + " to " + std::to_string(end - 1);
}

// A tile of a part, ready to be added.
struct Incoming {
  uint32_t tile = 0;
  std::vector<Film::Node> nodes;
  std::vector<float> brightest, first;
  std::vector<uint64_t> dropped;
  SampleAddress first_dropped{0, 0, 0};
};

// Reads a tile with a number above the last one's.
Incoming read_tile(Reader &reader, const Film &film, int64_t last) {
  Incoming incoming;
  incoming.tile = reader.number<uint32_t>();
  const auto count = reader.number<uint32_t>(), dropped = reader.number<uint32_t>(), first = reader.number<uint32_t>();
  if (incoming.tile >= film.tile_count() || int64_t(incoming.tile) <= last || count == 0 || dropped > kMostWidths || first > 1)
    refuse_damaged("its tiles are out of order");
  const Film::Tile &tile = film.tile(incoming.tile);
  const size_t pixels = tile.pixels();
  const Film::Channels channels = film.channels_of_pixel();
  if (pixels == 0 || count > kMostWidths * 2)
    refuse_damaged("tile " + std::to_string(incoming.tile) + " has no such sums");
  // Check the order of the sums.
  uint64_t end = 0;
  for (uint32_t i = 0; i < count; ++i) {
    Film::Node node;
    node.start = reader.number<uint32_t>();
    node.level = reader.number<uint32_t>();
    if (node.level >= kMostWidths || node.end() > kMostSamples || node.start < end ||
        (node.start & ((uint64_t(1) << node.level) - 1)) != 0)
      refuse_damaged("the sums of tile " + std::to_string(incoming.tile) + " are out of order");
    end = node.end();
    incoming.nodes.push_back(std::move(node));
  }
  if ((incoming.nodes.front().start == 0) != (first == 1))
    refuse_damaged("sample 0 of tile " + std::to_string(incoming.tile) + " is incomplete");
  for (Film::Node &node : incoming.nodes) {
    reader.numbers(node.sums.channels, pixels * channels.summed);
    reader.numbers(node.sums.differences, pixels);
    reader.numbers(node.sums.color_differences, pixels * channels.differences);
  }
  reader.numbers(incoming.brightest, pixels);
  reader.numbers(incoming.first, first * pixels * channels.first);
  reader.numbers(incoming.dropped, dropped);
  if (dropped > 0) {
    SampleAddress &address = incoming.first_dropped;
    for (uint32_t *number : {&address.x, &address.y, &address.sample})
      *number = reader.number<uint32_t>();
    if (address.x >= film.width() || address.y >= film.height())
      refuse_damaged("a dropped sample is outside the picture");
  }
  return incoming;
}

void require_apart(const Incoming &incoming, const Film::Tile &tile) {
  for (const Film::Node &node : incoming.nodes)
    for (const Film::Node &other : tile.nodes)
      if (node.start < other.end() && other.start < node.end())
        refuse_part(samples_of(std::max(node.start, other.start), std::min(node.end(), other.end())) + " of tile " +
                    std::to_string(incoming.tile) + ": the session has them already");
}

// Adds a tile's samples; allocates nothing.
void add(Incoming &&incoming, Film &film) {
  Film::Tile &tile = film.tile(incoming.tile);
  if (tile.count == 0)
    tile.brightest = std::move(incoming.brightest);
  else
    for (size_t pixel = 0; pixel < tile.brightest.size(); ++pixel)
      tile.brightest[pixel] = std::max(tile.brightest[pixel], incoming.brightest[pixel]);
  if (incoming.nodes.front().start == 0)
    tile.first = std::move(incoming.first);
  const auto order = [](const SampleAddress &address) { return std::tie(address.sample, address.y, address.x); };
  if (!incoming.dropped.empty()) {
    if (tile.dropped.empty() || order(incoming.first_dropped) < order(tile.first_dropped))
      tile.first_dropped = incoming.first_dropped;
    if (tile.dropped.size() < incoming.dropped.size())
      tile.dropped.swap(incoming.dropped);
    for (size_t i = 0; i < incoming.dropped.size(); ++i)
      tile.dropped[i] += incoming.dropped[i];
  }
  for (Film::Node &node : incoming.nodes)
    film.insert(tile, std::move(node));
}

Energy read_energy(Reader &reader) {
  // The last digit has the rest of the sum, which is far below this.
  constexpr int64_t kMost = int64_t(1) << 56;
  Energy energy;
  for (ExactSum *sum : {&energy.clipped, &energy.last, &energy.before_last}) {
    std::array<int64_t, ExactSum::kDigits> digits;
    for (int64_t &digit : digits)
      digit = reader.number<int64_t>();
    if (!std::all_of(digits.begin(), digits.end() - 1, [](int64_t digit) { return digit >= 0 && digit < 256; }) ||
        std::abs(digits.back()) > kMost)
      refuse_damaged("its sums of light are no numbers");
    *sum = ExactSum(digits);
  }
  return energy;
}

} // namespace

Part::Part(std::span<const std::byte> bytes) : bytes_(bytes) {
  if (bytes.size() < kPartMark.size() || std::memcmp(bytes.data(), kPartMark.data(), kPartMark.size()) != 0)
    refuse_part("these bytes are no part of a picture");
  Reader reader(bytes);
  reader.skip(kPartMark.size());
  if (bytes.size() < kPartHead + sizeof description_ + kPartEnd)
    refuse_part("it is incomplete: " + std::to_string(bytes.size()) + " bytes");
  const auto format = reader.number<uint32_t>(), abi = reader.number<uint32_t>();
  if (format != kPartFormat || abi != LANCER_ABI_VERSION)
    refuse_part("it has form " + std::to_string(format) + " of interface " + std::to_string(abi) + ", this library needs " +
                std::to_string(kPartFormat) + " of " + std::to_string(LANCER_ABI_VERSION));
  if (const auto size = reader.number<uint64_t>(); size != bytes.size())
    refuse_part("it is incomplete: " + std::to_string(bytes.size()) + " bytes of " + std::to_string(size));
  uint64_t sum;
  std::memcpy(&sum, bytes.data() + bytes.size() - kPartEnd, kPartEnd);
  if (sum != checksum(bytes.data(), bytes.size() - kPartEnd))
    refuse_damaged("its checksum differs");
  description_ = reader.number<lancer_part>();
  if (description_.hash != identity().hash())
    refuse_damaged("its hash is not that of its scene, camera and settings");
}

Identity Part::identity() const {
  Identity identity;
  std::copy_n(description_.digest, identity.digest.size(), identity.digest.begin());
  identity.has_digest = true;
  identity.camera = description_.camera;
  identity.settings = description_.settings;
  return identity;
}

Totals Part::add_to(Film &film) const {
  Reader reader(bytes_.first(bytes_.size() - kPartEnd));
  reader.skip(kPartHead + sizeof description_);
  Totals totals;
  for (uint64_t *number : {&totals.rays.camera, &totals.rays.bounce, &totals.rays.shadow, &totals.vertices})
    *number = reader.number<uint64_t>();
  totals.energy = read_energy(reader);
  // Read and check all tiles, then make room for their sums, then add them.
  std::vector<Incoming> tiles;
  uint64_t samples = 0;
  while (reader.left() > 0) {
    tiles.push_back(read_tile(reader, film, tiles.empty() ? -1 : int64_t(tiles.back().tile)));
    require_apart(tiles.back(), film.tile(tiles.back().tile));
    for (const Film::Node &node : tiles.back().nodes)
      samples += (node.end() - node.start) * film.tile(tiles.back().tile).pixels();
  }
  if (tiles.size() != description_.tiles || samples != description_.samples)
    refuse_part("it is incomplete: " + std::to_string(tiles.size()) + " tiles of " + std::to_string(description_.tiles));
  for (const Incoming &incoming : tiles) {
    Film::Tile &tile = film.tile(incoming.tile);
    tile.nodes.reserve(tile.nodes.size() + incoming.nodes.size());
  }
  for (Incoming &incoming : tiles)
    add(std::move(incoming), film);
  return totals;
}

} // namespace lancer
