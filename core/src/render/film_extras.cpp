// The passes of a film that have no bit: light groups and outputs, shadow catchers, mattes, the number of samples, the time.
#include "render/catchers.h"
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
    const size_t place = size_t(pixel) * layout_.summed_channels + layout_.first_extra + extra;
    for (uint32_t i = 0; i < count; ++i)
      target[i] = nearest_float(mean_of(tile, place + i));
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

glm::dvec4 Film::matte_of(const Tile &tile, uint32_t pixel) const {
  const size_t place = size_t(pixel) * layout_.summed_channels + layout_.first_extra + layout_.extras.matte();
  return {mean_of(tile, place), mean_of(tile, place + 1), mean_of(tile, place + 2), mean_of(tile, place + 3)};
}

glm::dvec3 Film::catcher_of(const Tile &tile, uint32_t pixel) const {
  const size_t place = size_t(pixel) * layout_.summed_channels;
  const size_t alone = place + layout_.first_extra + layout_.extras.catcher_light();
  const glm::dvec4 seen(mean_of(tile, place), mean_of(tile, place + 1), mean_of(tile, place + 2), mean_of(tile, place + 3));
  return catcher_factor(seen, matte_of(tile, pixel),
                        {mean_of(tile, alone), mean_of(tile, alone + 1), mean_of(tile, alone + 2)});
}

void Film::read_catcher(std::span<float> out) const {
  read_each(3, out, [&](const Tile &tile, uint32_t pixel, float *target) {
    const glm::vec3 factor = nearest_float(catcher_of(tile, pixel));
    std::copy_n(&factor.x, 3, target);
  });
}

void Film::read_shadows(bool over_environment, std::span<float> out) const {
  const size_t sky = layout_.at[uint32_t(Pass::Environment)];
  read_each(4, out, [&](const Tile &tile, uint32_t pixel, float *target) {
    const glm::dvec4 matte = matte_of(tile, pixel);
    const glm::dvec3 factor = catcher_of(tile, pixel);
    const size_t place = size_t(pixel) * layout_.summed_channels + sky;
    const glm::dvec4 picture =
        over_environment ? lancer::over_environment(matte, factor,
                                                    {mean_of(tile, place), mean_of(tile, place + 1), mean_of(tile, place + 2)})
                         : over_shadow(matte, factor);
    for (int i = 0; i < 4; ++i)
      target[i] = nearest_float(picture[i]);
  });
}

void Film::read_sample_count(std::span<float> out) const {
  read_each(1, out, [](const Tile &tile, uint32_t, float *target) { *target = float(tile.count); });
}

void Film::read_render_time(std::span<float> out) const {
  read_each(1, out, [](const Tile &tile, uint32_t, float *target) { *target = float(1e3 * tile.seconds / tile.pixels()); });
}

} // namespace lancer
