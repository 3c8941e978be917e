// A picture as kernels read it: its texels and plain numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace lancer {

struct Image;

// Steps of the lines that stand for the curve of sRGB between 0 and 1.
inline constexpr uint32_t kSrgbSteps = 4096;

struct WideImage {
  const std::byte *texels = nullptr;
  const float *lines = nullptr; // of the curve; null: the texels are linear
  uint32_t width = 0, height = 0, channels = 0;
  uint32_t texel_bytes = 0; // of a channel: 1, 2, or 4 for floats
  uint32_t repeats = 0;     // or its edges go on
  uint32_t alpha = 0;       // 0: nobody asks, 1: solid, 2: the fourth channel
  uint32_t straight = 0;    // the colour is divided by it
  uint32_t has_matrix = 0;
  float matrix[3][3] = {}; // columns
};

// As nodes with these flags look at it, and whether they ask for alpha; nothing where only lookup() can do it. As long as the
// image is neither changed nor moved.
std::optional<WideImage> wide_image(const Image &image, uint32_t flags, bool alpha = false);

} // namespace lancer
