// Checks images and copies those of rows. Their colours with straight alpha are multiplied by alpha here, once, in the stored
// bit depth.
#include "scene/description.h"
#include "scene/fill.h"
#include "scene/messages.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lancer {

namespace {

// The largest side; within it, the size in bytes fits 64 bits.
constexpr uint32_t kLargestSide = 1u << 20;

constexpr uintptr_t kBlockAlignment = 64;

uint8_t multiplied(uint8_t color, uint8_t alpha) { return uint8_t(uint32_t(color) * alpha / 255u); }
uint16_t multiplied(uint16_t color, uint16_t alpha) { return uint16_t(uint32_t(color) * alpha / 65535u); }
float multiplied(float color, float alpha) { return color * alpha; }

template <class Texel> void associate(Image &image) {
  auto *texel = reinterpret_cast<Texel *>(image.memory.get());
  const size_t count = size_t(image.width) * image.height;
  for (size_t i = 0; i < count; ++i, texel += 4)
    for (int c = 0; c < 3; ++c)
      texel[c] = multiplied(texel[c], texel[3]);
}

// Returns the number of texels that are not finite. They stay: a look-up that reads one gives black.
size_t count_gaps(const Image &image) {
  const auto *texel = reinterpret_cast<const float *>(image.texels);
  const size_t count = size_t(image.width) * image.height;
  size_t gaps = 0;
  for (size_t i = 0; i < count; ++i, texel += image.channels) {
    bool finite = true;
    for (uint32_t c = 0; c < image.channels; ++c)
      finite &= std::isfinite(texel[c]);
    gaps += !finite;
  }
  return gaps;
}

void check_image(const std::string &object, const lancer_image &source) {
  const auto refuse = [&](const char *what, uint64_t value, const char *expected) {
    bad_argument(object + ": " + what + " " + std::to_string(value) + " is not " + expected);
  };
  if (source.width == 0 || source.width > kLargestSide)
    refuse("width", source.width, "1 ... 1048576");
  if (source.height == 0 || source.height > kLargestSide)
    refuse("height", source.height, "1 ... 1048576");
  if (source.channels != 1 && source.channels != 3 && source.channels != 4)
    refuse("channels", source.channels, "1, 3 or 4");
  if (source.kind > LANCER_TEXEL_FLOAT)
    refuse("kind", source.kind, "one of 0, 1, 2");
  if (source.transfer > LANCER_TRANSFER_SRGB)
    refuse("transfer", source.transfer, "one of 0, 1");
  if (source.alpha > LANCER_ALPHA_NONE)
    refuse("alpha", source.alpha, "one of 0 ... 3");
  if (!source.texels)
    bad_argument(object + ": texels is NULL");
  if (source.layout > LANCER_LAYOUT_BLOCKS)
    refuse("layout", source.layout, "one of 0, 1");
  if (source.mipmaps > 1)
    refuse("mipmaps", source.mipmaps, "one of 0, 1");
  if (source.layout == LANCER_LAYOUT_BLOCKS) {
    if (const auto address = reinterpret_cast<uintptr_t>(source.texels); address % kBlockAlignment)
      refuse("address of the blocks", address, "a multiple of 64");
    if (source.alpha == LANCER_ALPHA_STRAIGHT && source.channels == 4)
      bad_argument(object + ": blocks have straight alpha, but are read in place: multiply their colour by alpha");
  }
  for (int i = 0; i < 9; ++i)
    if (!std::isfinite(source.matrix[i]))
      bad_argument(object + ": matrix contains " + to_text(source.matrix[i]));
}

void copy_rows(const std::string &object, const void *rows, Image &image) {
  const std::string texels = object + ": " + std::to_string(image.width) + " x " + std::to_string(image.height) + " texels";
  check_memory(texels, double(image.bytes()));
  try {
    image.keep(allocate_texels(image.bytes()));
  } catch (const std::bad_alloc &) {
    throw Error(Fault::Memory, texels + " need " + std::to_string(image.bytes() / 1000000) + " MB, more than is free");
  }
  std::memcpy(image.memory.get(), rows, image.level_bytes(0));
}

uint32_t levels_of(uint32_t width, uint32_t height) {
  uint32_t levels = 1;
  while (std::max(width, height) >> (levels - 1) > 1u << kBlockShift)
    ++levels;
  return levels;
}

} // namespace

Image read_image(const lancer_image &source, size_t number, Messages &messages) {
  const std::string object = label("image", source.name, number);
  check_image(object, source);
  Image image;
  image.name = source.name ? source.name : "";
  image.width = source.width;
  image.height = source.height;
  image.channels = source.channels;
  image.kind = static_cast<TexelKind>(source.kind);
  image.transfer = static_cast<Transfer>(source.transfer);
  image.alpha = static_cast<AlphaMode>(source.alpha);
  image.tile = source.tile;
  image.levels = source.mipmaps ? levels_of(source.width, source.height) : 1;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      image.matrix[column][row] = source.matrix[3 * row + column];
  image.has_matrix = image.matrix != glm::mat3(1.0f);
  const bool is_copied = source.layout == LANCER_LAYOUT_ROWS;
  image.in_blocks = !is_copied;
  if (is_copied)
    copy_rows(object, source.texels, image);
  else
    image.texels = static_cast<const std::byte *>(source.texels);
  if (const size_t gaps = image.kind != TexelKind::Float ? 0 : is_copied ? count_gaps(image) : source.gaps) {
    image.has_gaps = true;
    messages.add(object, std::to_string(gaps) + " texels are not finite, look-ups that read one give black");
  }
  if (is_copied && image.alpha == AlphaMode::Straight && image.channels == 4) {
    if (image.kind == TexelKind::U8)
      associate<uint8_t>(image);
    else if (image.kind == TexelKind::U16)
      associate<uint16_t>(image);
    else
      associate<float>(image);
  }
  return image;
}

void add_image(Description &description, const lancer_image &source) {
  Messages messages;
  Image image = read_image(source, description.images.size(), messages);
  description.images.emplace_back(std::move(image), std::move(messages));
}

} // namespace lancer
