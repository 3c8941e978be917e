// The reading of parts: all checks, then the sums.
#include "render/checksum.h"
#include "render/part_format.h"
#include "render/parts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
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

// Whether each sum can be one of finite floats. Others, far too large or too small, would leave the range of the numbers that
// passes and errors are computed from.
bool are_sums_of_floats(const Film::Node &node) {
  const double most = std::ldexp(double(std::numeric_limits<float>::max()), int(node.level));
  constexpr double kLeast = double(std::numeric_limits<float>::denorm_min());
  return std::ranges::all_of(node.sums.channels,
                             [&](double sum) { return sum == 0.0 || (std::abs(sum) >= kLeast && std::abs(sum) <= most); });
}

// Reads the mattes of a kind of a node.
void read_mattes(Reader &reader, size_t pixels, const Film::Node &node, MatteSums &mattes) {
  reader.numbers(mattes.ends, pixels);
  uint32_t begin = 0;
  for (const uint32_t end : mattes.ends) {
    if (end < begin || end - begin > LANCER_MOST_MATTES)
      refuse_damaged("its mattes are out of order");
    begin = end;
  }
  reader.numbers(mattes.ids, begin);
  reader.numbers(mattes.shares, begin);
  const double most = std::ldexp(double(std::numeric_limits<float>::max()), int(node.level));
  begin = 0;
  for (const uint32_t end : mattes.ends)
    for (const uint32_t first = begin; begin < end; ++begin)
      if (mattes.ids[begin] == 0 || (begin > first && mattes.ids[begin] <= mattes.ids[begin - 1]) ||
          !(mattes.shares[begin] > 0.0 && mattes.shares[begin] <= most))
        refuse_damaged("its mattes are out of order");
}

// Whether a tile can have dropped such samples: no more of any bit width than it has, and the first one of the lowest.
bool are_dropped(const Incoming &incoming, const Film::Tile &tile) {
  const SampleAddress &first = incoming.first_dropped;
  uint64_t of_width[kMostWidths] = {};
  bool has_first = false;
  for (const Film::Node &node : incoming.nodes) {
    has_first |= node.start <= first.sample && first.sample < node.end();
    // All samples of a node have the width of its start, unless it starts at 0.
    if (node.start > 0)
      of_width[std::bit_width(node.start)] += node.end() - node.start;
    for (uint32_t width = 0; node.start == 0 && width <= node.level; ++width)
      of_width[width] += width > 0 ? uint64_t(1) << (width - 1) : 1;
  }
  size_t lowest = 0;
  for (size_t width = incoming.dropped.size(); width-- > 0;) {
    if (incoming.dropped[width] > of_width[width] * tile.pixels())
      return false;
    if (incoming.dropped[width] > 0)
      lowest = width;
  }
  if (!has_first || incoming.dropped.back() == 0 || lowest != size_t(std::bit_width(first.sample)))
    return false;
  for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel)
    if (tile.place(pixel) == glm::uvec2(first.x, first.y))
      return true;
  return false;
}

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
  if (pixels == 0)
    refuse_damaged("tile " + std::to_string(incoming.tile) + " has no pixels");
  if (count > reader.left() / (2 * sizeof(uint32_t)))
    refuse_damaged("its size fits no tiles");
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
    for (uint32_t kind = 0; kind < kMatteKinds; ++kind)
      if (film.extras().has_mattes(kind))
        read_mattes(reader, pixels, node, node.sums.mattes[kind]);
    if (!are_sums_of_floats(node))
      refuse_damaged("a sum of tile " + std::to_string(incoming.tile) + " is no sum of its samples");
  }
  reader.numbers(incoming.brightest, pixels);
  if (std::ranges::any_of(incoming.brightest, [](float value) { return value < 0.0f; }))
    refuse_damaged("a largest luminance of tile " + std::to_string(incoming.tile) + " is negative");
  reader.numbers(incoming.first, first * pixels * channels.first);
  reader.numbers(incoming.dropped, dropped);
  if (dropped > 0) {
    SampleAddress &address = incoming.first_dropped;
    for (uint32_t *number : {&address.x, &address.y, &address.sample})
      *number = reader.number<uint32_t>();
    if (!are_dropped(incoming, tile))
      refuse_damaged("the dropped samples of tile " + std::to_string(incoming.tile) + " are not among its samples");
  }
  return incoming;
}

// The part and the film have their sums by rising start.
void require_apart(const Incoming &incoming, const Film::Tile &tile) {
  auto node = incoming.nodes.begin();
  auto other = tile.nodes.begin();
  while (node != incoming.nodes.end() && other != tile.nodes.end()) {
    if (node->start < other->end() && other->start < node->end())
      refuse_part(samples_of(std::max(node->start, other->start), std::min(node->end(), other->end())) + " of tile " +
                  std::to_string(incoming.tile) + ": the session has them already");
    if (node->start < other->start)
      ++node;
    else
      ++other;
  }
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

// Far above all totals of samples, and low enough that sums of two stay in the range of their numbers.
constexpr int64_t kMostTotal = int64_t(1) << 60;

// Whether no sum of the rays or of the light, whose rest is in the last digit, is too large.
bool are_numbers(const Totals &totals) {
  for (const uint64_t count : {totals.rays.camera, totals.rays.bounce, totals.rays.shadow, totals.vertices})
    if (count > uint64_t(kMostTotal))
      return false;
  for (const ExactSum *sum : Energy::sums(totals.energy))
    if (const int64_t rest = sum->digits().back(); rest < -kMostTotal || rest > kMostTotal)
      return false;
  return true;
}

Totals read_totals(Reader &reader) {
  Totals totals;
  for (uint64_t *number : {&totals.rays.camera, &totals.rays.bounce, &totals.rays.shadow, &totals.vertices})
    *number = reader.number<uint64_t>();
  bool are_digits = true;
  for (ExactSum *sum : Energy::sums(totals.energy)) {
    std::array<int64_t, ExactSum::kDigits> digits;
    for (int64_t &digit : digits)
      digit = reader.number<int64_t>();
    are_digits &= std::all_of(digits.begin(), digits.end() - 1, [](int64_t digit) { return digit >= 0 && digit < 256; });
    *sum = ExactSum(digits);
  }
  // Removed light is counted by absolute values, and changed light also by its squares.
  const Energy &energy = totals.energy;
  const bool below_zero =
      std::ranges::any_of(std::array{&energy.clipped, &energy.clipped_direct, &energy.cut, &energy.no_caustics,
                                     &energy.filtered.squares, &energy.guessed.squares},
                          [](const ExactSum *sum) { return sum->digits().back() < 0; });
  if (!are_digits || !are_numbers(totals) || below_zero)
    refuse_damaged("its sums of rays or light are no numbers");
  return totals;
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
  std::copy_n(description_.release, identity.release.size(), identity.release.begin());
  return identity;
}

Totals Part::add_to(Film &film, const Totals &others) const {
  Reader reader(bytes_.first(bytes_.size() - kPartEnd));
  reader.skip(kPartHead + sizeof description_);
  Totals totals = read_totals(reader);
  totals += others;
  if (!are_numbers(totals))
    refuse_part("its sums of rays or light, together with the session's, are no numbers");
  // Read and check all tiles, then make room for their sums, then add them.
  std::vector<Incoming> tiles;
  uint64_t samples = 0;
  uint32_t first = ~0u, end = 0;
  while (reader.left() > 0) {
    tiles.push_back(read_tile(reader, film, tiles.empty() ? -1 : int64_t(tiles.back().tile)));
    const std::vector<Film::Node> &nodes = tiles.back().nodes;
    const Film::Tile &tile = film.tile(tiles.back().tile);
    require_apart(tiles.back(), tile);
    for (const Film::Node &node : nodes)
      samples += (node.end() - node.start) * tile.pixels();
    first = std::min(first, nodes.front().start);
    end = std::max(end, uint32_t(nodes.back().end()));
  }
  if (tiles.size() != description_.tiles)
    refuse_part("it is incomplete: " + std::to_string(tiles.size()) + " tiles of " + std::to_string(description_.tiles));
  if (samples != description_.samples || std::min(first, end) != description_.first || end != description_.end)
    refuse_damaged("its description tells other samples than its tiles have");
  for (const Incoming &incoming : tiles) {
    Film::Tile &tile = film.tile(incoming.tile);
    tile.nodes.reserve(tile.nodes.size() + incoming.nodes.size());
  }
  for (Incoming &incoming : tiles)
    add(std::move(incoming), film);
  return totals;
}

} // namespace lancer
