#include "nodes/mipmaps.h"

#include "nodes/image.h"
#include "sampling/elementary.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>
#include <vector>

namespace lancer {

namespace {

float linear_to_srgb(float c) {
  if (c < 0.0031308f)
    return c < 0.0f ? 0.0f : c * 12.92f;
  return 1.055f * pow(c, 1.0f / 2.4f) - 0.055f;
}

// Whether a colour is divided by its alpha before a curve, and multiplied by it after.
bool divides_by_alpha(const float *texel, uint32_t channels) { return channels == 4 && texel[3] > 0.0f && texel[3] != 1.0f; }

// Applies a curve to the colour of a texel.
template <class Curve> void bend(float *texel, uint32_t channels, const Curve &curve) {
  const bool divides = divides_by_alpha(texel, channels);
  const float alpha = divides ? texel[3] : 1.0f;
  for (uint32_t c = 0; c < std::min(channels, 3u); ++c)
    texel[c] = divides ? curve(texel[c] / alpha) * alpha : curve(texel[c]);
}

void store(float value, uint8_t &texel) { texel = uint8_t(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f); }
void store(float value, uint16_t &texel) { texel = uint16_t(std::clamp(value, 0.0f, 1.0f) * 65535.0f + 0.5f); }
void store(float value, float &texel) { texel = value; }

// The byte of each linear number in sRGB, without a power for each: images of bytes take an eighth to a quarter of the time.
class SrgbBytes {
public:
  SrgbBytes() {
    for (uint32_t i = 0; i < 256; ++i) {
      // Bisect for the least number of the byte; floats that are not negative stand in the order of their bits.
      uint32_t low = 0, high = std::bit_cast<uint32_t>(1.0f);
      while (low < high)
        if (const uint32_t middle = (low + high) / 2; of_curve(std::bit_cast<float>(middle)) < i)
          low = middle + 1;
        else
          high = middle;
      least_[i] = std::bit_cast<float>(low);
    }
    for (uint32_t i = 0; i <= kSteps; ++i)
      at_[i] = of_curve(float(i) / float(kSteps));
  }
  uint8_t operator()(float linear) const {
    const float c = std::clamp(linear, 0.0f, 1.0f);
    uint32_t byte = at_[uint32_t(c * float(kSteps))];
    while (byte < 255 && c >= least_[byte + 1])
      ++byte;
    return uint8_t(byte);
  }

private:
  static constexpr uint32_t kSteps = 4096;
  static uint8_t of_curve(float linear) {
    uint8_t byte = 0;
    store(linear_to_srgb(linear), byte);
    return byte;
  }

  float least_[256];
  uint8_t at_[kSteps + 1];
};

float unit_of(uint8_t value) { return float(value) * (1.0f / 255.0f); }
float unit_of(uint16_t value) { return float(value) * (1.0f / 65535.0f); }
float unit_of(float value) { return value; }

// Decode and encode the colour of a texel of bytes that is not divided by its alpha.
void decode_srgb(const uint8_t *texel, uint32_t channels, float *numbers) {
  const float *const linear = srgb_bytes();
  for (uint32_t c = 0; c < std::min(channels, 3u); ++c)
    numbers[c] = linear[texel[c]];
}
void encode_srgb(const float *numbers, uint32_t channels, uint8_t *texel) {
  static const SrgbBytes to_byte;
  for (uint32_t c = 0; c < std::min(channels, 3u); ++c)
    texel[c] = to_byte(numbers[c]);
  if (channels == 4)
    store(numbers[3], texel[3]);
}

// Decodes texels to numbers that may be averaged: a texel that is not finite becomes 0.
template <class Texel> void decode(const Image &image, const Texel *texels, size_t count, float *numbers) {
  for (size_t i = 0; i < count; ++i, texels += image.channels, numbers += image.channels) {
    bool finite = true;
    for (uint32_t c = 0; c < image.channels; ++c) {
      numbers[c] = unit_of(texels[c]);
      finite &= std::isfinite(numbers[c]);
    }
    if constexpr (std::is_same_v<Texel, uint8_t>)
      if (image.transfer == Transfer::Srgb && !divides_by_alpha(numbers, image.channels)) {
        decode_srgb(texels, image.channels, numbers);
        continue;
      }
    if (!finite)
      std::fill_n(numbers, image.channels, 0.0f);
    if (image.transfer == Transfer::Srgb)
      bend(numbers, image.channels, srgb_to_linear);
  }
}

template <class Texel> void encode(const Image &image, const float *numbers, size_t count, Texel *texels) {
  float texel[4];
  for (size_t i = 0; i < count; ++i, texels += image.channels, numbers += image.channels) {
    if constexpr (std::is_same_v<Texel, uint8_t>)
      if (image.transfer == Transfer::Srgb && !divides_by_alpha(numbers, image.channels)) {
        encode_srgb(numbers, image.channels, texels);
        continue;
      }
    std::copy_n(numbers, image.channels, texel);
    if (image.transfer == Transfer::Srgb)
      bend(texel, image.channels, linear_to_srgb);
    for (uint32_t c = 0; c < image.channels; ++c)
      store(texel[c], texels[c]);
  }
}

// The two texels of the level before between which a texel lies, along one side.
struct Between {
  uint32_t low, high;
  float share; // of high
};
Between between(uint32_t i, uint32_t side, uint32_t before) {
  const double place = (i + 0.5) * before / side - 0.5, low = std::floor(place);
  return {uint32_t(low), std::min(uint32_t(low) + 1, before - 1), float(place - low)};
}

template <class Texel> void make(Image &image) {
  const auto at = [&](uint32_t level) { return reinterpret_cast<Texel *>(image.memory.get() + image.level_offset(level)); };
  const uint32_t channels = image.channels;
  std::vector<float> before, now, rows[2];
  for (uint32_t level = 1; level < image.levels; ++level) {
    const uint32_t width = level_side(image.width, level), height = level_side(image.height, level);
    const uint32_t width_before = level_side(image.width, level - 1), height_before = level_side(image.height, level - 1);
    const size_t row_before = size_t(width_before) * channels;
    now.resize(size_t(width) * height * channels);
    for (uint32_t y = 0; y < height; ++y) {
      const Between up = between(y, height, height_before);
      const float *from[2];
      for (int i = 0; i < 2; ++i) {
        const size_t first = (i ? up.high : up.low) * row_before;
        if (level == 1) {
          rows[i].resize(row_before);
          decode(image, at(0) + first, width_before, rows[i].data());
        }
        from[i] = level == 1 ? rows[i].data() : before.data() + first;
      }
      float *to = now.data() + size_t(y) * width * channels;
      for (uint32_t x = 0; x < width; ++x) {
        const Between across = between(x, width, width_before);
        const size_t left = size_t(across.low) * channels, right = size_t(across.high) * channels;
        for (uint32_t c = 0; c < channels; ++c) {
          const auto mixed = [&](const float *row) {
            return (1.0f - across.share) * row[left + c] + across.share * row[right + c];
          };
          *to++ = (1.0f - up.share) * mixed(from[0]) + up.share * mixed(from[1]);
        }
      }
    }
    encode(image, now.data(), size_t(width) * height, at(level));
    std::swap(before, now);
  }
}

} // namespace

void make_mipmaps(Image &image) {
  if (image.kind == TexelKind::U8)
    make<uint8_t>(image);
  else if (image.kind == TexelKind::U16)
    make<uint16_t>(image);
  else
    make<float>(image);
}

} // namespace lancer
