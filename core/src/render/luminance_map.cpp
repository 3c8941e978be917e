#include "render/luminance_map.h"

#include <algorithm>

namespace lancer {

namespace {

// In units of the mean. No pixel of light comes near it; colours below zero, which the mean leaves out, may go beyond. Squares
// of it, of a neighbourhood together and over a hundredth squared, are still floats.
constexpr double kMost = 1e15;

} // namespace

LuminanceMap::LuminanceMap(const Film &film) : width(film.width()), height(film.height()) {
  const size_t pixels = size_t(width) * height;
  for (std::vector<float> *values : {&mean, &variance, &brightest, &count})
    values->assign(pixels, 0.0f);
  std::vector<Film::Luminance> luminances;
  // Find the unit.
  double sum = 0.0;
  for (size_t i = 0; i < film.tile_count(); ++i) {
    luminances.resize(film.tile(i).pixels());
    if (film.luminances(film.tile(i), luminances) == 0)
      known = false;
    else
      for (const Film::Luminance &luminance : luminances)
        sum += std::max(luminance.mean, 0.0);
  }
  dark = !(sum > 0.0);
  unit = dark ? 1.0 : sum / double(pixels);
  // Lay out what tiles know.
  for (size_t i = 0; i < film.tile_count(); ++i) {
    const Film::Tile &tile = film.tile(i);
    luminances.resize(tile.pixels());
    const uint32_t samples = film.luminances(tile, luminances);
    if (samples == 0)
      continue;
    for (uint32_t pixel = 0; pixel < tile.pixels(); ++pixel) {
      const glm::uvec2 at = tile.place(pixel);
      const size_t to = size_t(at.y) * width + at.x;
      mean[to] = float(std::clamp(luminances[pixel].mean / unit, -kMost, kMost));
      variance[to] = float(std::min(luminances[pixel].variance / (unit * unit) * samples, kMost * kMost));
      brightest[to] = float(luminances[pixel].brightest / unit);
      count[to] = float(samples);
    }
  }
}

} // namespace lancer
