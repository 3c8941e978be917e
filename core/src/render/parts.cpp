#include "render/parts.h"

#include "render/checksum.h"
#include "scene/messages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <tuple>

namespace lancer {

namespace {

constexpr std::string_view kMark = "LANCERPT";
constexpr uint32_t kFormat = 1;
// Samples of a pixel, and the bit width of the last one's number.
constexpr uint64_t kMostSamples = uint64_t(1) << 31;
constexpr uint32_t kMostWidths = 32;

// Settings that change no bit of a sample, and the splits, of which a part tells the numbers in use.
constexpr std::string_view kFree[] = {"samples", "split_lights", "split_paths", "features", "threads", "tile_size", "refines"};

constexpr bool is_free(std::string_view name) { return std::ranges::find(kFree, name) != std::end(kFree); }

// CLASSIC takes the centres of pixel, lens and lights for a picture of one sample.
bool has_centres(const lancer_settings &settings) { return settings.integrator == LANCER_CLASSIC && settings.samples == 1; }

[[noreturn]] void refuse(const std::string &why) { bad_argument("part: " + why); }
[[noreturn]] void refuse_damaged(const std::string &why) { refuse("it is damaged: " + why); }

// The head and the end of a part: mark, format, interface, size; checksum.
constexpr size_t kHead = kMark.size() + 2 * sizeof(uint32_t) + sizeof(uint64_t), kEnd = sizeof(uint64_t);

class Writer {
public:
  explicit Writer(std::span<std::byte> out) : out_(out) {}

  void write(const void *from, size_t size) {
    if (size > 0)
      std::memcpy(out_.data() + at_, from, size);
    at_ += size;
  }
  template <class Number> void number(Number value) { write(&value, sizeof value); }
  template <class Number> void numbers(const std::vector<Number> &values) {
    write(values.data(), values.size() * sizeof(Number));
  }
  size_t written() const { return at_; }

private:
  std::span<std::byte> out_;
  size_t at_ = 0;
};

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

bool is_first(const Film::Tile &tile) { return !tile.nodes.empty() && tile.nodes.front().start == 0; }

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
        refuse(samples_of(std::max(node.start, other.start), std::min(node.end(), other.end())) + " of tile " +
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

void write_energy(Writer &writer, const Energy &energy) {
  for (const ExactSum *sum : {&energy.clipped, &energy.last, &energy.before_last})
    for (const int64_t digit : sum->digits())
      writer.number(digit);
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

uint64_t Identity::hash() const {
  static_assert(sizeof(lancer_part) == 32 + 16 + sizeof(lancer_camera) + sizeof(lancer_settings) + 20, "no padding");
  static_assert(sizeof(lancer_settings) == sizeof(uint32_t) * 27, "no padding");
  static_assert(sizeof(lancer_camera) == 12 * sizeof(double) + 8 * sizeof(uint32_t) + 18 * sizeof(double), "no padding");
  lancer_settings fixed = settings;
#define LANCER_FIX(kind, name, given, most)                                                                                    \
  if (is_free(#name))                                                                                                          \
    fixed.name = 0;
  LANCER_SETTINGS(LANCER_FIX)
#undef LANCER_FIX
  fixed.samples = has_centres(settings);
  std::byte bytes[sizeof digest + sizeof camera + sizeof fixed];
  Writer writer(bytes);
  writer.write(digest.data(), sizeof digest);
  writer.write(&camera, sizeof camera);
  writer.write(&fixed, sizeof fixed);
  return checksum(bytes, sizeof bytes);
}

void Identity::require_same(const Identity &other) const {
  if (other.digest != digest)
    refuse("it is of another scene");
  if (other.camera.region_width != camera.region_width || other.camera.region_height != camera.region_height)
    refuse("its region has " + std::to_string(other.camera.region_width) + " x " + std::to_string(other.camera.region_height) +
           " pixels, the session's " + std::to_string(camera.region_width) + " x " + std::to_string(camera.region_height));
  if (std::memcmp(&other.camera, &camera, sizeof camera) != 0)
    refuse("it is of another camera");
#define LANCER_COMPARE(kind, name, given, most)                                                                                \
  if (!is_free(#name) && other.settings.name != settings.name)                                                                 \
    refuse("its setting " #name " is " + std::to_string(other.settings.name) + ", the session's " +                            \
           std::to_string(settings.name));
  LANCER_SETTINGS(LANCER_COMPARE)
#undef LANCER_COMPARE
  if (has_centres(other.settings) != has_centres(settings))
    refuse("CLASSIC takes other places for a picture of one sample");
}

Totals &Totals::operator+=(const Totals &other) {
  rays += other.rays;
  vertices += other.vertices;
  energy += other.energy;
  return *this;
}

Totals &Totals::operator-=(const Totals &other) {
  rays -= other.rays;
  vertices -= other.vertices;
  energy -= other.energy;
  return *this;
}

size_t part_size(const Film &film) {
  const Film::Channels channels = film.channels_of_pixel();
  size_t size = kHead + sizeof(lancer_part) + 4 * sizeof(uint64_t) + 3 * ExactSum::kDigits * sizeof(int64_t) + kEnd;
  for (size_t i = 0; i < film.tile_count(); ++i) {
    const Film::Tile &tile = film.tile(i);
    if (tile.count == 0)
      continue;
    const size_t pixels = tile.pixels();
    const size_t of_node = pixels * (channels.summed * sizeof(double) + (1 + channels.differences) * sizeof(float));
    size += 4 * sizeof(uint32_t) + tile.nodes.size() * (2 * sizeof(uint32_t) + of_node);
    size += pixels * (1 + (is_first(tile) ? channels.first : 0)) * sizeof(float);
    size += tile.dropped.size() * sizeof(uint64_t) + (tile.dropped.empty() ? 0 : 3 * sizeof(uint32_t));
  }
  return size;
}

void write_part(const Film &film, const Identity &identity, const Splits &splits, const Totals &totals,
                std::span<std::byte> out) {
  lancer_part description{};
  std::copy(identity.digest.begin(), identity.digest.end(), description.digest);
  description.hash = identity.hash();
  description.camera = identity.camera;
  description.settings = identity.settings;
  // Equal samples give equal bytes on every machine.
  lancer_settings &settings = description.settings;
  settings.features = settings.threads = settings.tile_size = 0;
  description.split_lights = settings.split_lights = splits.lights;
  description.split_paths = settings.split_paths = splits.paths;
  description.first = ~0u;
  for (size_t i = 0; i < film.tile_count(); ++i) {
    const Film::Tile &tile = film.tile(i);
    if (tile.count == 0)
      continue;
    ++description.tiles;
    description.samples += uint64_t(tile.count) * tile.pixels();
    description.first = std::min(description.first, tile.nodes.front().start);
    description.end = std::max(description.end, tile.next());
  }
  description.first = std::min(description.first, description.end);
  Writer writer(out);
  writer.write(kMark.data(), kMark.size());
  writer.number(kFormat);
  writer.number(LANCER_ABI_VERSION);
  writer.number(uint64_t(out.size()));
  writer.number(description);
  for (const uint64_t number : {totals.rays.camera, totals.rays.bounce, totals.rays.shadow, totals.vertices})
    writer.number(number);
  write_energy(writer, totals.energy);
  for (uint32_t i = 0; i < film.tile_count(); ++i) {
    const Film::Tile &tile = film.tile(i);
    if (tile.count == 0)
      continue;
    writer.number(i);
    writer.number(uint32_t(tile.nodes.size()));
    writer.number(uint32_t(tile.dropped.size()));
    writer.number(uint32_t(is_first(tile)));
    for (const Film::Node &node : tile.nodes) {
      writer.number(node.start);
      writer.number(node.level);
    }
    for (const Film::Node &node : tile.nodes) {
      writer.numbers(node.sums.channels);
      writer.numbers(node.sums.differences);
      writer.numbers(node.sums.color_differences);
    }
    writer.numbers(tile.brightest);
    if (is_first(tile))
      writer.numbers(tile.first);
    writer.numbers(tile.dropped);
    if (!tile.dropped.empty())
      for (const uint32_t number : {tile.first_dropped.x, tile.first_dropped.y, tile.first_dropped.sample})
        writer.number(number);
  }
  writer.number(checksum(out.data(), writer.written()));
}

Part::Part(std::span<const std::byte> bytes) : bytes_(bytes) {
  if (bytes.size() < kMark.size() || std::memcmp(bytes.data(), kMark.data(), kMark.size()) != 0)
    refuse("these bytes are no part of a picture");
  Reader reader(bytes);
  reader.skip(kMark.size());
  if (bytes.size() < kHead + sizeof description_ + kEnd)
    refuse("it is incomplete: " + std::to_string(bytes.size()) + " bytes");
  const auto format = reader.number<uint32_t>(), abi = reader.number<uint32_t>();
  if (format != kFormat || abi != LANCER_ABI_VERSION)
    refuse("it has form " + std::to_string(format) + " of interface " + std::to_string(abi) + ", this library needs " +
           std::to_string(kFormat) + " of " + std::to_string(LANCER_ABI_VERSION));
  if (const auto size = reader.number<uint64_t>(); size != bytes.size())
    refuse("it is incomplete: " + std::to_string(bytes.size()) + " bytes of " + std::to_string(size));
  uint64_t sum;
  std::memcpy(&sum, bytes.data() + bytes.size() - kEnd, kEnd);
  if (sum != checksum(bytes.data(), bytes.size() - kEnd))
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
  Reader reader(bytes_.first(bytes_.size() - kEnd));
  reader.skip(kHead + sizeof description_);
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
    refuse("it is incomplete: " + std::to_string(tiles.size()) + " tiles of " + std::to_string(description_.tiles));
  for (const Incoming &incoming : tiles) {
    Film::Tile &tile = film.tile(incoming.tile);
    tile.nodes.reserve(tile.nodes.size() + incoming.nodes.size());
  }
  for (Incoming &incoming : tiles)
    add(std::move(incoming), film);
  return totals;
}

} // namespace lancer
