#include "render/picture_error.h"

#include <algorithm>
#include <queue>

namespace lancer {

namespace {

struct Half {
  double pixels = 0.0;
  double own = 0.0, other = 0.0; // sum over pixels of a sample's relative variance: what it has, and what its other half says
  double count = 0.0, planned = 0.0;

  // What doubling takes off the sum of squared errors, for each sample that it costs.
  double gain() const { return other / (2.0 * planned * planned * pixels); }
};

} // namespace

Refinement plan_refinement(const Film &film, const LuminanceMap &map, const RelativeVariance &relative, double target,
                           uint32_t most) {
  std::vector<Half> halves(film.tile_count());
  for (size_t i = 0; i < halves.size(); ++i) {
    const Film::Tile &tile = film.tile(i);
    Half &half = halves[i];
    half.pixels = tile.pixels();
    half.count = half.planned = tile.count;
    for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel) {
      const glm::uvec2 at = tile.place(pixel);
      const size_t place = size_t(at.y) * map.width + at.x;
      half.own += 0.5 * (double(relative.own[place]) + relative.shared[place]);
    }
  }
  // A half without pixels has nothing to say about its other half, which then goes by itself.
  for (size_t i = 0; i < halves.size(); ++i) {
    const Half &other = halves[i ^ 1];
    halves[i].other = other.pixels > 0.0 ? other.own * halves[i].pixels / other.pixels : halves[i].own;
  }
  double error = 0.0;
  std::vector<uint32_t> order;
  for (uint32_t i = 0; i < halves.size(); ++i) {
    const Half &half = halves[i];
    if (half.pixels == 0.0)
      continue;
    error += half.own / half.count;
    if (2.0 * half.count <= most)
      order.push_back(i);
  }
  // Double in thought whatever gains most until the target is met.
  const auto gains_less = [&](uint32_t a, uint32_t b) {
    return halves[a].gain() != halves[b].gain() ? halves[a].gain() < halves[b].gain() : a > b;
  };
  std::priority_queue<uint32_t, std::vector<uint32_t>, decltype(gains_less)> queue(gains_less, order);
  const double goal = target * target * double(map.size());
  Refinement result;
  while (!queue.empty() && (target > 0.0 ? error > goal || result.tiles.empty() : result.tiles.size() < order.size())) {
    const uint32_t i = queue.top();
    queue.pop();
    Half &half = halves[i];
    if (half.planned == half.count)
      result.tiles.push_back(i);
    error -= half.other / (2.0 * half.planned);
    result.samples += half.planned * half.pixels;
    half.planned *= 2.0;
    if (target > 0.0 && 2.0 * half.planned <= most)
      queue.push(i);
  }
  return result;
}

} // namespace lancer
