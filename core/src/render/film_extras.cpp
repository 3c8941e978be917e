// The passes of a film that have no bit: light groups and outputs, mattes, the number of samples, the time.
#include "render/film.h"
#include "simd/vectors.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace lancer {

template <class Write> void Film::read_each(uint32_t width, std::span<float> out, Write &&write) const {
  std::ranges::fill(out, 0.0f);
  for (const auto &tile : tiles_) {
    const std::lock_guard lock(tile->mutex);
    for (uint32_t pixel = 0; pixel < tile->pixels() && tile->count > 0; ++pixel) {
      const glm::uvec2 at = tile->place(pixel);
      write(*tile, pixel, out.data() + (size_t(at.y) * width_ + at.x) * width);
    }
  }
}

void Film::read_extra(uint32_t extra, uint32_t count, std::span<float> out) const {
  read_each(count, out, [&](const Tile &tile, uint32_t pixel, float *target) {
    for (uint32_t i = 0; i < count; ++i) {
      // Join the waiting sums, later and smaller ones first, as the tree would.
      const size_t place = size_t(pixel) * layout_.summed_channels + layout_.first_extra + extra + i;
      double sum = 0.0;
      for (auto node = tile.nodes.rbegin(); node != tile.nodes.rend(); ++node)
        sum = node->sums.channels[place] + sum;
      target[i] = nearest_float(sum / double(tile.count));
    }
  });
}

void Film::read_mattes(uint32_t kind, uint32_t number, std::span<float> out) const {
  std::vector<uint32_t> order;
  read_each(4, out, [&](const Tile &tile, uint32_t pixel, float *target) {
    MatteSums sum;
    sum.ends.push_back(0);
    for (auto node = tile.nodes.rbegin(); node != tile.nodes.rend(); ++node) {
      MatteSums of_node;
      of_node.ends.push_back(of_node.append(node->sums.mattes[kind], pixel));
      sum.join(of_node, node->start);
    }
    order.resize(sum.ids.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](uint32_t a, uint32_t b) { return sum.shares[a] > sum.shares[b]; });
    for (uint32_t i = 0; i < 2 && 2 * number + i < order.size(); ++i) {
      const uint32_t matte = order[2 * number + i];
      target[2 * i] = std::bit_cast<float>(sum.ids[matte]);
      target[2 * i + 1] = nearest_float(sum.shares[matte] / double(tile.count));
    }
  });
}

void Film::read_sample_count(std::span<float> out) const {
  read_each(1, out, [](const Tile &tile, uint32_t, float *target) { *target = float(tile.count); });
}

void Film::read_render_time(std::span<float> out) const {
  read_each(1, out, [](const Tile &tile, uint32_t, float *target) { *target = float(1e3 * tile.seconds / tile.pixels()); });
}

} // namespace lancer
