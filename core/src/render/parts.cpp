#include "render/parts.h"

#include "render/checksum.h"
#include "render/part_format.h"

#include <algorithm>
#include <cstring>

namespace lancer {

namespace {

// Settings that change no bit of a sample, and the splits, of which a part tells the numbers in use.
constexpr std::string_view kFree[] = {"samples", "split_lights", "split_paths", "features", "threads", "tile_size", "refines"};

constexpr bool is_free(std::string_view name) { return std::ranges::find(kFree, name) != std::end(kFree); }

// CLASSIC takes the centres of pixel, lens and lights for a picture of one sample.
bool has_centres(const lancer_settings &settings) { return settings.integrator == LANCER_CLASSIC && settings.samples == 1; }

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

bool is_first(const Film::Tile &tile) { return !tile.nodes.empty() && tile.nodes.front().start == 0; }

void write_energy(Writer &writer, const Energy &energy) {
  for (const ExactSum *sum : Energy::sums(energy))
    for (const int64_t digit : sum->digits())
      writer.number(digit);
}

} // namespace

uint64_t Identity::hash() const {
  static_assert(sizeof(lancer_part) == 32 + 16 + 16 + sizeof(lancer_camera) + sizeof(lancer_settings) + 24, "no padding");
  static_assert(sizeof(lancer_settings) == sizeof(uint32_t) * 46, "no padding");
  static_assert(sizeof(lancer_camera) == 36 * sizeof(double) + 8 * sizeof(uint32_t) + 30 * sizeof(double), "no padding");
  lancer_settings fixed = settings;
#define LANCER_FIX(kind, name, given, most)                                                                                    \
  if (is_free(#name))                                                                                                          \
    fixed.name = 0;
  LANCER_SETTINGS(LANCER_FIX)
#undef LANCER_FIX
  fixed.samples = has_centres(settings);
  std::byte bytes[sizeof digest + sizeof release + sizeof camera + sizeof fixed];
  Writer writer(bytes);
  writer.write(digest.data(), sizeof digest);
  writer.write(release.data(), sizeof release);
  writer.write(&camera, sizeof camera);
  writer.write(&fixed, sizeof fixed);
  return checksum(bytes, sizeof bytes);
}

void Identity::require_same(const Identity &other) const {
  const auto text = [](const Identity &identity) {
    std::string name(identity.release.begin(), std::ranges::find(identity.release, '\0'));
    // A hostile part may have any bytes.
    std::ranges::replace_if(
        name, [](char c) { return c < ' ' || c > '~'; }, '?');
    return name;
  };
  if (other.release != release)
    refuse_part("it is of Lancer " + text(other) + ", the session of " + text(*this));
  if (other.digest != digest)
    refuse_part("it is of another scene");
  if (other.camera.region_width != camera.region_width || other.camera.region_height != camera.region_height)
    refuse_part("its region has " + std::to_string(other.camera.region_width) + " x " +
                std::to_string(other.camera.region_height) + " pixels, the session's " + std::to_string(camera.region_width) +
                " x " + std::to_string(camera.region_height));
  if (std::memcmp(&other.camera, &camera, sizeof camera) != 0)
    refuse_part("it is of another camera");
#define LANCER_COMPARE(kind, name, given, most)                                                                                \
  if (!is_free(#name) && other.settings.name != settings.name)                                                                 \
    refuse_part("its setting " #name " is " + std::to_string(other.settings.name) + ", the session's " +                       \
                std::to_string(settings.name));
  LANCER_SETTINGS(LANCER_COMPARE)
#undef LANCER_COMPARE
  if (has_centres(other.settings) != has_centres(settings))
    refuse_part("CLASSIC takes other places for a picture of one sample");
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
  size_t size =
      kPartHead + sizeof(lancer_part) + 4 * sizeof(uint64_t) + Energy::kSums * ExactSum::kDigits * sizeof(int64_t) + kPartEnd;
  for (size_t i = 0; i < film.tile_count(); ++i) {
    const Film::Tile &tile = film.tile(i);
    if (tile.count == 0)
      continue;
    const size_t pixels = tile.pixels();
    const size_t of_node = pixels * (channels.summed * sizeof(double) + (1 + channels.differences) * sizeof(float));
    for (const Film::Node &node : tile.nodes)
      for (const MatteSums &mattes : node.sums.mattes)
        size += (mattes.ends.size() + mattes.ids.size()) * sizeof(uint32_t) + mattes.shares.size() * sizeof(double);
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
  std::copy(identity.release.begin(), identity.release.end(), description.release);
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
  writer.write(kPartMark.data(), kPartMark.size());
  writer.number(kPartFormat);
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
      for (const MatteSums &mattes : node.sums.mattes) {
        writer.numbers(mattes.ends);
        writer.numbers(mattes.ids);
        writer.numbers(mattes.shares);
      }
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

} // namespace lancer
