#include "render/film.h"

#include "simd/memory.h"
#include "simd/vectors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

namespace lancer {

namespace {

void join_channels(const Film::Sums &earlier, Film::Sums &later) {
  for (size_t i = 0; i < later.channels.size(); ++i)
    later.channels[i] = earlier.channels[i] + later.channels[i];
}

const float *numbers_of(const SampleResult &result) { return &result.radiance.x; }

// Whether two nodes are the halves of one subtree.
bool are_halves(const Film::Node &earlier, const Film::Node &later) {
  return earlier.level == later.level && earlier.end() == later.start && (earlier.start >> earlier.level & 1u) == 0;
}

// Turns the later half into the subtree.
void take_half(Film::Node &later) {
  later.start -= 1u << later.level;
  ++later.level;
}

} // namespace

Film::Layout::Layout(uint32_t passes, const ExtraLayout &given) : extras(given) {
  const uint32_t kept = kept_passes(passes);
  for (uint32_t i = 0; i < kPassCount; ++i) {
    const Pass pass = static_cast<Pass>(i);
    if (!(kept & bit(pass)))
      continue;
    uint32_t &next = of_first_sample(pass) ? first_channels : summed_channels;
    add(of_first_sample(pass) ? first : summed, pass, next);
    at[i] = next;
    next += kept_channels(pass);
  }
  first_extra = summed_channels;
  summed_channels += extras.channels();
  for (const Pass pass : {Pass::Halves, Pass::AlbedoHalves, Pass::NormalHalves})
    if (passes & bit(pass)) {
      halves.push_back(pass);
      at[uint32_t(pass)] = difference_channels;
      difference_channels += channels(pass);
    }
}

void Film::Layout::add(std::vector<Run> &runs, Pass pass, uint32_t to) {
  const uint32_t from = place_in_sample(pass), count = kept_channels(pass);
  if (!runs.empty() && runs.back().from + runs.back().count == from)
    runs.back().count += count;
  else
    runs.push_back({from, to, count});
}

// Pixels are numbered row by row; in a chessboard, every pair of rows has as many cells of each colour as the tile is wide.
uint32_t Film::Tile::pixels() const {
  if (cells == Cells::All)
    return width * height;
  const uint32_t begin = cells == Cells::Even ? 0 : 1;
  return height / 2 * width + (height % 2) * ((width + 1 - begin) / 2);
}

glm::uvec2 Film::Tile::place(uint32_t pixel) const {
  if (cells == Cells::All)
    return {x + pixel % width, y + pixel / width};
  const uint32_t begin = cells == Cells::Even ? 0 : 1;
  const uint32_t pair = pixel / width, within = pixel % width, upper = (width + 1 - begin) / 2;
  if (within < upper)
    return {x + begin + 2 * within, y + 2 * pair};
  return {x + (1 - begin) + 2 * (within - upper), y + 2 * pair + 1};
}

Film::Film(uint32_t width, uint32_t height, uint32_t tile_size, uint32_t passes, bool halves, const ExtraLayout &extras)
    : width_(width), height_(height), passes_(passes | bit(Pass::Combined)), halves_(halves), layout_(passes, extras) {
  for (uint32_t y = 0; y < height; y += tile_size) {
    for (uint32_t x = 0; x < width; x += tile_size) {
      for (const Cells cells : {halves ? Cells::Even : Cells::All, Cells::Odd}) {
        if (cells == Cells::Odd && !halves)
          continue;
        auto tile = std::make_unique<Tile>();
        tile->x = x;
        tile->y = y;
        tile->width = std::min(tile_size, width - x);
        tile->height = std::min(tile_size, height - y);
        tile->cells = cells;
        tiles_.push_back(std::move(tile));
      }
    }
  }
}

double Film::bytes_needed(double width, double height, uint32_t passes, uint32_t sums, const ExtraLayout &extras) {
  // Most pixels show few surfaces.
  constexpr double kUsualMattes = 4.0;
  constexpr double kOfMattes = sizeof(uint32_t) + kUsualMattes * (sizeof(uint32_t) + sizeof(double));
  const Layout layout(passes, extras);
  return width * height *
         ((double(layout.summed_channels) * sizeof(double) + double(1 + layout.difference_channels) * sizeof(float) +
           std::popcount(extras.mattes) * kOfMattes) *
              sums +
          double(layout.first_channels + 1) * sizeof(float));
}

void Film::add(Tile &tile, uint32_t samples, std::span<const SampleResult> results, const Extras &extras) {
  const uint32_t pixels = tile.pixels();
  const MattesBySample mattes(extras.mattes, layout_.extras.mattes ? results.size() : 0);
  const std::lock_guard lock(tile.mutex);
  if (tile.count == 0) {
    if (tile.first_sample == 0)
      keep_first(tile, results);
    tile.brightest.resize(pixels);
  }
  // Sums that have been joined leave their memory to the next ones.
  std::vector<Sums> spare;
  for (uint32_t s = 0; s < samples; ++s) {
    Node leaf{tile.next(), 0, {}};
    // Find the complete neighbours with which the leaf is joined.
    size_t joined = 0;
    while (joined < tile.nodes.size() && are_halves(tile.nodes[tile.nodes.size() - 1 - joined], leaf)) {
      ++joined;
      take_half(leaf);
    }
    // Allocate first: if memory is missing, the samples counted so far stay valid.
    tile.nodes.reserve(tile.nodes.size() + 1);
    spare.reserve(spare.size() + joined);
    if (!spare.empty()) {
      leaf.sums = std::move(spare.back());
      spare.pop_back();
    }
    leaf.sums.channels.resize(size_t(pixels) * layout_.summed_channels);
    leaf.sums.differences.assign(pixels, 0.0f);
    leaf.sums.color_differences.assign(size_t(pixels) * layout_.difference_channels, 0.0f);
    const size_t first = size_t(s) * pixels;
    gather(results.subspan(first, pixels), extras.channels.data() + first * layout_.extras.channels(), leaf.sums,
           tile.brightest.data());
    gather_mattes(mattes, first, pixels, leaf.sums);
    for (size_t i = 0; i < joined; ++i)
      join_mattes(tile.nodes[tile.nodes.size() - 1 - i], leaf.sums);
    // Join smaller sample numbers first.
    for (size_t i = 0; i < joined; ++i) {
      Node &earlier = tile.nodes.back();
      if (i + 1 == joined)
        keep_differences(earlier.sums, earlier.level, leaf.sums);
      join_channels(earlier.sums, leaf.sums);
      spare.push_back(std::move(earlier.sums));
      tile.nodes.pop_back();
    }
    tile.nodes.push_back(std::move(leaf));
    ++tile.count;
  }
}

// The sum of 2^k equal numbers is exactly 2^k times the number.
void Film::add_even(Tile &tile, uint32_t samples, const SampleResult &result, const Extras &extras) {
  const uint32_t pixels = tile.pixels();
  const std::lock_guard lock(tile.mutex);
  const std::vector<SampleResult> results(pixels, result);
  Sums leaf;
  leaf.channels.resize(size_t(pixels) * layout_.summed_channels);
  leaf.differences.assign(pixels, 0.0f);
  leaf.color_differences.assign(size_t(pixels) * layout_.difference_channels, 0.0f);
  if (tile.count == 0) {
    if (tile.first_sample == 0)
      keep_first(tile, results);
    tile.brightest.resize(pixels);
  }
  std::vector<float> even;
  for (uint32_t pixel = 0; pixel < pixels; ++pixel)
    even.insert(even.end(), extras.channels.begin(), extras.channels.end());
  gather(results, even.data(), leaf, tile.brightest.data());
  gather_mattes(MattesBySample({}, layout_.extras.mattes ? pixels : 0), 0, pixels, leaf);
  // Divide the samples into the largest subtrees.
  std::vector<Node> nodes;
  uint32_t start = tile.next();
  const uint32_t end = start + samples;
  while (start < end) {
    const uint32_t largest = std::bit_floor(end - start), aligned = start == 0 ? largest : start & (0 - start);
    const auto level = uint32_t(std::countr_zero(std::min(largest, aligned)));
    nodes.push_back({start, level, leaf});
    for (double &channel : nodes.back().sums.channels)
      channel *= double(1u << level);
    start += 1u << level;
  }
  tile.nodes.reserve(tile.nodes.size() + nodes.size());
  for (Node &node : nodes)
    insert_locked(tile, std::move(node));
}

void Film::insert(Tile &tile, Node &&node) const {
  const std::lock_guard lock(tile.mutex);
  insert_locked(tile, std::move(node));
}

void Film::insert_locked(Tile &tile, Node &&node) const {
  tile.count += 1u << node.level;
  auto at = std::upper_bound(tile.nodes.begin(), tile.nodes.end(), node.start,
                             [](uint32_t start, const Node &other) { return start < other.start; });
  at = tile.nodes.insert(at, std::move(node));
  const auto join_with_next = [&](std::vector<Node>::iterator earlier) {
    const auto later = earlier + 1;
    keep_differences(earlier->sums, earlier->level, later->sums);
    join_mattes(*earlier, later->sums);
    join_channels(earlier->sums, later->sums);
    take_half(*later);
    return tile.nodes.erase(earlier);
  };
  while (true) {
    if (at != tile.nodes.begin() && are_halves(*(at - 1), *at))
      at = join_with_next(at - 1);
    else if (at + 1 != tile.nodes.end() && are_halves(*at, *(at + 1)))
      at = join_with_next(at);
    else
      return;
  }
}

void Film::clear(Tile &tile, uint32_t first_sample) {
  const std::lock_guard lock(tile.mutex);
  tile.first_sample = first_sample;
  tile.count = 0;
  tile.nodes.clear();
  tile.first.clear();
  tile.brightest.clear();
  tile.dropped.clear();
  tile.seconds = 0.0;
}

void Film::drop(Tile &tile, const SampleAddress &address) {
  const std::lock_guard lock(tile.mutex);
  if (tile.dropped.empty())
    tile.first_dropped = address;
  const auto width = size_t(std::bit_width(address.sample));
  if (tile.dropped.size() <= width)
    tile.dropped.resize(width + 1);
  ++tile.dropped[width];
}

Film::Dropped Film::dropped() const {
  const auto order = [](const SampleAddress &address) { return std::tie(address.sample, address.y, address.x); };
  Dropped result;
  for (const auto &tile : tiles_) {
    const std::lock_guard lock(tile->mutex);
    if (tile->dropped.empty())
      continue;
    if (result.samples == 0 || order(tile->first_dropped) < order(result.first))
      result.first = tile->first_dropped;
    result.samples += std::accumulate(tile->dropped.begin(), tile->dropped.end(), uint64_t(0));
  }
  return result;
}

void Film::round_down(Tile &tile) {
  const std::lock_guard lock(tile.mutex);
  if (!tile.whole())
    return;
  tile.count = std::bit_floor(tile.count);
  tile.nodes.resize(std::min<size_t>(tile.nodes.size(), 1));
  // The sample numbers below a power of two are those with a smaller bit width.
  const auto width = size_t(std::bit_width(tile.count));
  if (tile.dropped.size() > width) {
    tile.dropped.resize(width);
    while (!tile.dropped.empty() && tile.dropped.back() == 0)
      tile.dropped.pop_back();
  }
}

std::pair<uint32_t, uint32_t> Film::sample_range() const {
  uint32_t least = ~0u, most = 0;
  for (const auto &tile : tiles_) {
    if (tile->pixels() == 0)
      continue;
    const std::lock_guard lock(tile->mutex);
    least = std::min(least, tile->count);
    most = std::max(most, tile->count);
  }
  return {least, most};
}

void Film::keep_first(Tile &tile, std::span<const SampleResult> results) const {
  tile.first.resize(size_t(tile.pixels()) * layout_.first_channels);
  for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel)
    for (const Layout::Run &run : layout_.first)
      std::copy_n(numbers_of(results[pixel]) + run.from, run.count,
                  tile.first.data() + size_t(pixel) * layout_.first_channels + run.to);
}

glm::dvec3 Film::mean_color(Pass pass, const Sums &sums, uint32_t level, uint32_t pixel) const {
  const double *color = sums.channels.data() + size_t(pixel) * layout_.summed_channels + layout_.at[uint32_t(pass)];
  return glm::dvec3(color[0], color[1], color[2]) / double(1u << level);
}

double Film::mean_luminance(const Sums &sums, uint32_t level, uint32_t pixel) const {
  return luminance(mean_color(Pass::Combined, sums, level, pixel));
}

// Stores the differences of two halves before they are joined; each half has 2^level samples.
void Film::keep_differences(const Sums &earlier, uint32_t level, Sums &later) const {
  for (uint32_t pixel = 0; pixel < later.differences.size(); ++pixel)
    later.differences[pixel] = nearest_float(mean_luminance(earlier, level, pixel) - mean_luminance(later, level, pixel));
  for (const Pass pass : layout_.halves)
    for (uint32_t pixel = 0; pixel < later.differences.size(); ++pixel) {
      const Pass of = halved(pass);
      const glm::dvec3 apart = mean_color(of, earlier, level, pixel) - mean_color(of, later, level, pixel);
      for (uint32_t i = 0; i < 3; ++i)
        later.color_differences[size_t(pixel) * layout_.difference_channels + layout_.at[uint32_t(pass)] + i] =
            nearest_float(apart[int(i)]);
    }
}

void Film::join_mattes(const Node &earlier, Sums &later) const {
  const uint32_t key = hash_combine(earlier.start, earlier.level);
  for (uint32_t kind = 0; kind < kMatteKinds; ++kind)
    if (layout_.extras.has_mattes(kind))
      later.mattes[kind].join(earlier.sums.mattes[kind], key);
}

void Film::gather_mattes(const MattesBySample &mattes, size_t first, uint32_t pixels, Sums &sums) const {
  for (uint32_t kind = 0; kind < kMatteKinds; ++kind)
    if (layout_.extras.has_mattes(kind))
      sums.mattes[kind].gather(mattes, kind, first, pixels);
}

// Stores one sample of all pixels in the layout of the sums.
void Film::gather(std::span<const SampleResult> results, const float *extras, Sums &sums, float *brightest) const {
  const uint32_t of_extras = layout_.extras.channels();
  double *to = sums.channels.data();
  for (const SampleResult &result : results) {
    *brightest = std::max(*brightest, std::abs(luminance(result.radiance)));
    ++brightest;
    // The picture comes first, and is mostly the only pass.
    const float *numbers = numbers_of(result);
    for (uint32_t i = 0; i < 4; ++i)
      to[i] = double(numbers[i]);
    if (layout_.first_extra > 4)
      for (const Layout::Run &run : layout_.summed)
        std::copy_n(numbers + run.from, run.count, to + run.to);
    std::copy_n(extras, of_extras, to + layout_.first_extra);
    extras += of_extras;
    to += layout_.summed_channels;
  }
}

bool Film::finite(const SampleResult &result, const float *extras) const {
  // x - x is 0 for a finite x and NaN otherwise. Four floats at a time; the last ones of a run may be tested twice.
  const float *numbers = numbers_of(result);
  Float<4> sum(0.0f);
  float rest = 0.0f;
  for (const Layout::Run &run : layout_.summed) {
    const float *from = numbers + run.from;
    for (uint32_t i = 0; run.count >= 4 && i < run.count; i += 4) {
      alignas(16) float four[4];
      std::copy_n(from + std::min(i, run.count - 4), 4, four);
      sum += load_lanes<4>(four) - load_lanes<4>(four);
    }
    for (uint32_t i = 0; run.count < 4 && i < run.count; ++i)
      rest += from[i] - from[i];
  }
  for (uint32_t i = 0; extras && i < layout_.extras.channels(); ++i)
    rest += extras[i] - extras[i];
  return all(sum == Float<4>(0.0f)) && rest == 0.0f;
}

size_t Film::bytes() const {
  size_t bytes = 0;
  for (const auto &tile : tiles_) {
    const std::lock_guard lock(tile->mutex);
    bytes += sizeof(Tile) + (tile->first.capacity() + tile->brightest.capacity()) * sizeof(float);
    bytes += tile->dropped.capacity() * sizeof(uint64_t);
    for (const Node &node : tile->nodes) {
      for (const MatteSums &mattes : node.sums.mattes)
        bytes += mattes.bytes();
      bytes += sizeof(node) + node.sums.channels.capacity() * sizeof(double) +
               (node.sums.differences.capacity() + node.sums.color_differences.capacity()) * sizeof(float);
    }
  }
  return bytes;
}

} // namespace lancer
