// Pictures in memory, and weighted means over the neighbourhoods of their pixels.
#pragma once

#include "simd/vectors.h"

#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace lancer {

// A picture of one number or of three numbers a pixel.
template <class Value> struct Grid {
  uint32_t width = 0, height = 0;
  std::vector<Value> values;

  Grid(uint32_t w, uint32_t h) : width(w), height(h), values(size_t(w) * h, Value(0.0f)) {}
  Value *row(uint32_t y) { return values.data() + size_t(y) * width; }
  const Value *row(uint32_t y) const { return values.data() + size_t(y) * width; }
};
using Colors = Grid<glm::vec3>;
using Numbers = Grid<float>;

// Returns the place i of an infinite row that repeats the row of count places mirrored at its ends.
inline uint32_t mirrored(int64_t i, uint32_t count) {
  const int64_t period = 2 * int64_t(count);
  i = (i % period + period) % period;
  return uint32_t(i < count ? i : period - 1 - i);
}

// Returns the convolution with a symmetric kernel in both directions; kernel: from its middle on. step: of the kept pixels. It
// is a constant because the compiler joins loads of neighbours for a step of 1.
template <uint32_t step = 1, class Value> Grid<Value> convolved(const Grid<Value> &grid, std::span<const float> kernel) {
  const auto reach = int64_t(kernel.size()) - 1;
  const uint32_t width = (grid.width + step - 1) / step, height = (grid.height + step - 1) / step;
  Grid<Value> rows(grid.width, height), result(width, height);
  for (uint32_t y = 0; y < height; ++y)
    for (int64_t d = -reach; d <= reach; ++d) {
      const Value *from = grid.row(mirrored(int64_t(y) * step + d, grid.height));
      const float weight = kernel[size_t(std::abs(d))];
      Value *to = rows.row(y);
      for (uint32_t x = 0; x < grid.width; ++x)
        to[x] += weight * from[x];
    }
  std::vector<Value> wide(grid.width + 2 * size_t(reach));
  for (uint32_t y = 0; y < height; ++y) {
    const Value *from = rows.row(y);
    for (size_t i = 0; i < wide.size(); ++i)
      wide[i] = from[mirrored(int64_t(i) - reach, grid.width)];
    Value *to = result.row(y);
    for (int64_t d = -reach; d <= reach; ++d) {
      const float weight = kernel[size_t(std::abs(d))];
      for (uint32_t x = 0; x < width; ++x)
        to[x] += weight * wide[size_t(int64_t(x) * step + d + reach)];
    }
  }
  return result;
}

inline Numbers times(const Numbers &a, const Numbers &b) {
  Numbers product(a.width, a.height);
  for (size_t i = 0; i < product.values.size(); ++i)
    product.values[i] = a.values[i] * b.values[i];
  return product;
}

// Returns the kernel of a neighbourhood whose weights fall to 0 at this distance, each raised to a power.
inline std::vector<float> tent(int reach, int power = 1) {
  std::vector<float> kernel;
  for (int d = 0; d < reach; ++d) {
    const float weight = float(reach - d) / float(reach * reach);
    kernel.push_back(power == 1 ? weight : weight * weight);
  }
  return kernel;
}

} // namespace lancer
