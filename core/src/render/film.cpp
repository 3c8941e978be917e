#include "render/film.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lancer {

namespace {

// Channels that sample 0 alone decides: depth, position, object and material index.
constexpr uint32_t kFirstChannels = 6;
constexpr float kNothing = 1e10f;

uint32_t summed_channels(uint32_t passes) {
  return 4 + ((passes & (1u << uint32_t(Pass::Normal))) ? 3 : 0) + ((passes & (1u << uint32_t(Pass::Albedo))) ? 3 : 0);
}

bool needs_first(uint32_t passes) {
  constexpr uint32_t first = 1u << uint32_t(Pass::Depth) | 1u << uint32_t(Pass::Position) | 1u << uint32_t(Pass::ObjectIndex) |
                             1u << uint32_t(Pass::MaterialIndex);
  return (passes & first) != 0;
}

} // namespace

uint32_t channels(Pass pass) {
  switch (pass) {
  case Pass::Combined:
    return 4;
  case Pass::Normal:
  case Pass::Albedo:
  case Pass::Position:
    return 3;
  case Pass::Depth:
  case Pass::ObjectIndex:
  case Pass::MaterialIndex:
    break;
  }
  return 1;
}

Film::Film(uint32_t width, uint32_t height, uint32_t tile_size, uint32_t passes)
    : width_(width), height_(height), passes_(passes | 1u << uint32_t(Pass::Combined)), summed_(summed_channels(passes_)) {
  uint32_t next = 4;
  if (has(Pass::Normal)) {
    normal_ = next;
    next += 3;
  }
  if (has(Pass::Albedo))
    albedo_ = next;
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
  const double per_pixel =
      double(summed_channels(passes)) * sizeof(double) + (needs_first(passes) ? kFirstChannels * sizeof(float) : 0);
  return width * height * per_pixel;
}

void Film::add(Tile &tile, uint32_t samples, std::span<const SampleResult> results) {
  const uint32_t pixels = tile.pixels(), before = tile.count, after = before + samples;
  const uint32_t levels_before = uint32_t(std::popcount(before)), levels_after = uint32_t(std::popcount(after));
  std::vector<double> sums(size_t(pixels) * levels_after * summed_);
  // The waiting sums of one pixel, by level of the tree.
  std::vector<double> pending(33 * size_t(summed_));
  std::vector<double> carry(summed_);
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const double *from = tile.sums.data() + size_t(pixel) * levels_before * summed_;
    for (uint32_t level = 0; level < 32; ++level) {
      if (before >> level & 1u) {
        std::copy(from, from + summed_, pending.begin() + std::ptrdiff_t(level * summed_));
        from += summed_;
      }
    }
    for (uint32_t s = 0; s < samples; ++s) {
      // A new leaf joins every complete neighbour, the smaller numbers first.
      const SampleResult &result = results[size_t(s) * pixels + pixel];
      const float combined[4] = {result.radiance.x, result.radiance.y, result.radiance.z, result.alpha};
      std::copy(combined, combined + 4, carry.begin());
      for (int i = 0; i < 3 && normal_; ++i)
        carry[normal_ + uint32_t(i)] = double(result.normal[i]);
      for (int i = 0; i < 3 && albedo_; ++i)
        carry[albedo_ + uint32_t(i)] = double(result.albedo[i]);
      uint32_t level = 0;
      for (uint32_t count = before + s; count & 1u; count >>= 1, ++level)
        for (uint32_t c = 0; c < summed_; ++c)
          carry[c] = pending[level * summed_ + c] + carry[c];
      std::copy(carry.begin(), carry.end(), pending.begin() + std::ptrdiff_t(level * summed_));
    }
    double *to = sums.data() + size_t(pixel) * levels_after * summed_;
    for (uint32_t level = 0; level < 32; ++level) {
      if (after >> level & 1u) {
        std::copy_n(pending.begin() + std::ptrdiff_t(level * summed_), summed_, to);
        to += summed_;
      }
    }
  }
  std::vector<float> first;
  if (before == 0 && needs_first(passes_)) {
    first.reserve(size_t(pixels) * kFirstChannels);
    for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
      const SampleResult &result = results[pixel];
      first.insert(first.end(), {result.depth, result.position.x, result.position.y, result.position.z, result.object_index,
                                 result.material_index});
    }
  }
  const std::lock_guard lock(tile.mutex);
  tile.sums.swap(sums);
  if (before == 0)
    tile.first.swap(first);
  tile.count = after;
}

void Film::read(Pass pass, std::span<float> out) const {
  const uint32_t width = channels(pass);
  const uint32_t summed_from = pass == Pass::Normal ? normal_ : pass == Pass::Albedo ? albedo_ : 0;
  const bool summed = pass == Pass::Combined || pass == Pass::Normal || pass == Pass::Albedo;
  const uint32_t first_from = pass == Pass::Depth ? 0 : pass == Pass::Position ? 1 : pass == Pass::ObjectIndex ? 4 : 5;
  for (const auto &tile : tiles_) {
    const std::lock_guard lock(tile->mutex);
    const uint32_t levels = uint32_t(std::popcount(tile->count));
    for (uint32_t pixel = 0; pixel < tile->pixels(); ++pixel) {
      const size_t x = tile->x + pixel % tile->width, y = tile->y + pixel / tile->width;
      float *target = out.data() + (y * width_ + x) * width;
      for (uint32_t c = 0; c < width; ++c) {
        if (tile->count == 0) {
          target[c] = pass == Pass::Depth ? kNothing : 0.0f;
        } else if (summed) {
          // Join the waiting sums, later and smaller ones first, as the tree would.
          double sum = 0.0;
          for (uint32_t level = 0; level < levels; ++level)
            sum = tile->sums[(size_t(pixel) * levels + level) * summed_ + summed_from + c] + sum;
          target[c] = float(sum / double(tile->count));
        } else {
          target[c] = tile->first[size_t(pixel) * kFirstChannels + first_from + c];
        }
      }
    }
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
