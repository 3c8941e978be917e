#include "render/film.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lancer {

namespace {

constexpr float kNothing = 1e10f;
// A pass has no more channels than these, a count no more bits.
constexpr uint32_t kMostChannels = 4, kLevels = 32;

} // namespace

Film::Layout::Layout(uint32_t passes) {
  const uint32_t kept = kept_passes(passes);
  for (uint32_t i = 0; i < kPassCount; ++i) {
    const Pass pass = static_cast<Pass>(i);
    if (!(kept & bit(pass)))
      continue;
    uint32_t &next = of_first_sample(pass) ? first_channels : summed_channels;
    (of_first_sample(pass) ? first : summed).push_back(pass);
    at[i] = next;
    next += channels(pass);
  }
}

Film::Film(uint32_t width, uint32_t height, uint32_t tile_size, uint32_t passes)
    : width_(width), height_(height), passes_(passes | bit(Pass::Combined)), layout_(passes) {
  for (uint32_t y = 0; y < height; y += tile_size) {
    for (uint32_t x = 0; x < width; x += tile_size) {
      auto tile = std::make_unique<Tile>();
      tile->x = x;
      tile->y = y;
      tile->width = std::min(tile_size, width - x);
      tile->height = std::min(tile_size, height - y);
      tiles_.push_back(std::move(tile));
    }
  }
}

double Film::bytes_needed(double width, double height, uint32_t passes) {
  const Layout layout(passes);
  return width * height * (double(layout.summed_channels) * sizeof(double) + double(layout.first_channels) * sizeof(float));
}

void Film::add(Tile &tile, uint32_t samples, std::span<const SampleResult> results) {
  const uint32_t summed = layout_.summed_channels, pixels = tile.pixels(), before = tile.count, after = before + samples;
  const uint32_t levels_before = uint32_t(std::popcount(before)), levels_after = uint32_t(std::popcount(after));
  std::vector<double> sums(size_t(pixels) * levels_after * summed);
  // The waiting sums of one pixel, by level of the tree.
  std::vector<double> pending((kLevels + 1) * size_t(summed));
  std::vector<double> carry(summed);
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const double *from = tile.sums.data() + size_t(pixel) * levels_before * summed;
    for (uint32_t level = 0; level < kLevels; ++level) {
      if (before >> level & 1u) {
        std::copy(from, from + summed, pending.begin() + std::ptrdiff_t(level * summed));
        from += summed;
      }
    }
    for (uint32_t s = 0; s < samples; ++s) {
      // A new leaf joins every complete neighbour, the smaller numbers first.
      for (const Pass pass : layout_.summed)
        copy_channels(results[size_t(s) * pixels + pixel], pass, carry.data() + layout_.at[uint32_t(pass)]);
      uint32_t level = 0;
      for (uint32_t count = before + s; count & 1u; count >>= 1, ++level)
        for (uint32_t c = 0; c < summed; ++c)
          carry[c] = pending[level * summed + c] + carry[c];
      std::copy(carry.begin(), carry.end(), pending.begin() + std::ptrdiff_t(level * summed));
    }
    double *to = sums.data() + size_t(pixel) * levels_after * summed;
    for (uint32_t level = 0; level < kLevels; ++level) {
      if (after >> level & 1u) {
        std::copy_n(pending.begin() + std::ptrdiff_t(level * summed), summed, to);
        to += summed;
      }
    }
  }
  std::vector<float> first;
  if (before == 0) {
    first.resize(size_t(pixels) * layout_.first_channels);
    for (uint32_t pixel = 0; pixel < pixels; ++pixel)
      for (const Pass pass : layout_.first)
        copy_channels(results[pixel], pass, first.data() + size_t(pixel) * layout_.first_channels + layout_.at[uint32_t(pass)]);
  }
  const std::lock_guard lock(tile.mutex);
  tile.sums.swap(sums);
  if (before == 0)
    tile.first.swap(first);
  tile.count = after;
}

bool Film::finite(const SampleResult &result) const {
  for (const Pass pass : layout_.summed) {
    float values[kMostChannels];
    copy_channels(result, pass, values);
    if (!std::all_of(values, values + channels(pass), [](float value) { return std::isfinite(value); }))
      return false;
  }
  return true;
}

void Film::read(Pass pass, std::span<float> out) const {
  const uint32_t width = channels(pass);
  for (const auto &tile : tiles_) {
    const std::lock_guard lock(tile->mutex);
    for (uint32_t pixel = 0; pixel < tile->pixels(); ++pixel) {
      const size_t x = tile->x + pixel % tile->width, y = tile->y + pixel / tile->width;
      float *target = out.data() + (y * width_ + x) * width;
      if (tile->count == 0)
        std::fill_n(target, width, pass == Pass::Depth ? kNothing : 0.0f);
      else if (of_first_sample(pass))
        std::copy_n(tile->first.data() + size_t(pixel) * layout_.first_channels + layout_.at[uint32_t(pass)], width, target);
      else
        read_means(pass, *tile, pixel, target);
    }
  }
}

void Film::read_means(Pass pass, const Tile &tile, uint32_t pixel, float *target) const {
  const uint32_t levels = uint32_t(std::popcount(tile.count));
  const double *from = tile.sums.data() + size_t(pixel) * levels * layout_.summed_channels;
  const auto mean = [&](Pass of, uint32_t channel) {
    // Join the waiting sums, later and smaller ones first, as the tree would.
    double sum = 0.0;
    for (uint32_t level = 0; level < levels; ++level)
      sum = from[size_t(level) * layout_.summed_channels + layout_.at[uint32_t(of)] + channel] + sum;
    return sum / double(tile.count);
  };
  const auto color = [&](Pass of) { return glm::dvec3(mean(of, 0), mean(of, 1), mean(of, 2)); };
  if (divisor(pass) != pass) {
    const glm::vec3 light(divide_by_color(color(pass), color(divisor(pass))));
    for (int i = 0; i < 3; ++i)
      target[i] = light[i];
  } else if (pass == Pass::Mist) {
    // Samples count what is clear; the sky is all mist.
    target[0] = float(std::clamp(1.0 - mean(pass, 0), 0.0, 1.0));
  } else {
    for (uint32_t c = 0; c < channels(pass); ++c)
      target[c] = float(mean(pass, c));
  }
}

size_t Film::bytes() const {
  size_t bytes = 0;
  for (const auto &tile : tiles_) {
    const std::lock_guard lock(tile->mutex);
    bytes += sizeof(Tile) + tile->sums.capacity() * sizeof(double) + tile->first.capacity() * sizeof(float);
  }
  return bytes;
}

} // namespace lancer
