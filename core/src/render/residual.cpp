#include "render/residual.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lancer {

namespace {

// The kernel of the pyramid.
constexpr std::array<float, 3> kSmall = {6.0f / 16.0f, 4.0f / 16.0f, 1.0f / 16.0f};

Colors reduced(const Colors &fine) { return convolved<2>(fine, kSmall); }

// Adds a coarser level times a sign to a finer one, interpolated with the pyramid's kernel.
void add_expanded(const Colors &coarse, float sign, Colors &fine) {
  const auto at = [](const glm::vec3 *line, uint32_t place, uint32_t count, uint32_t stride) {
    const uint32_t i = place / 2;
    const auto value = [&](int64_t k) { return line[size_t(std::clamp<int64_t>(k, 0, int64_t(count) - 1)) * stride]; };
    return place % 2 == 0 ? 0.125f * value(int64_t(i) - 1) + 0.75f * value(i) + 0.125f * value(int64_t(i) + 1)
                          : 0.5f * value(i) + 0.5f * value(int64_t(i) + 1);
  };
  std::vector<glm::vec3> line(coarse.width);
  for (uint32_t y = 0; y < fine.height; ++y) {
    for (uint32_t x = 0; x < coarse.width; ++x)
      line[x] = at(coarse.values.data() + x, y, coarse.height, coarse.width);
    glm::vec3 *to = fine.row(y);
    for (uint32_t x = 0; x < fine.width; ++x)
      to[x] += sign * at(line.data(), x, coarse.width, 1);
  }
}

// The neighbourhood of 9 x 9 in which a share is estimated, and the standard deviations by which its noise may exceed the mean.
constexpr int kShareReach = 5;
constexpr float kDoubt = 2.0f;

// Returns the share of the residual that is not noise.
Numbers shares(const Level &band) {
  Numbers noise(band.residual.width, band.residual.height), squares = noise, power = noise;
  for (size_t i = 0; i < noise.values.size(); ++i) {
    noise.values[i] = glm::dot(band.noise.values[i], band.taken.values[i]);
    squares.values[i] = noise.values[i] * noise.values[i];
    power.values[i] = glm::dot(band.residual.values[i], band.residual.values[i]);
  }
  noise = convolved(noise, tent(kShareReach));
  power = convolved(power, tent(kShareReach));
  squares = convolved(squares, tent(kShareReach, 2));
  for (size_t i = 0; i < noise.values.size(); ++i) {
    const float most = noise.values[i] + kDoubt * std::sqrt(squares.values[i]);
    noise.values[i] = power.values[i] > 0.0f ? std::clamp(1.0f - most / power.values[i], 0.0f, 1.0f) : 0.0f;
  }
  return noise;
}

constexpr uint32_t kLevels = 6, kLeastSide = 8;

// levels: the number of coarser levels that may follow.
void keep_shares(Level &level, uint32_t levels) {
  const bool last = levels == 0 || std::min(level.residual.width, level.residual.height) < 2 * kLeastSide;
  Level coarse{last ? Colors(0, 0) : reduced(level.residual), last ? Colors(0, 0) : reduced(level.noise),
               last ? Colors(0, 0) : reduced(level.taken)};
  if (!last) {
    add_expanded(coarse.residual, -1.0f, level.residual);
    add_expanded(coarse.noise, -1.0f, level.noise);
    add_expanded(coarse.taken, -1.0f, level.taken);
  }
  const Numbers share = shares(level);
  for (size_t i = 0; i < share.values.size(); ++i) {
    level.residual.values[i] *= share.values[i];
    level.taken.values[i] *= share.values[i];
  }
  if (last)
    return;
  keep_shares(coarse, levels - 1);
  add_expanded(coarse.residual, 1.0f, level.residual);
  add_expanded(coarse.taken, 1.0f, level.taken);
}

} // namespace

void keep_shares(Level &level) { keep_shares(level, kLevels); }

} // namespace lancer
