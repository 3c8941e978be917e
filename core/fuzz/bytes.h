// Decisions from bytes: mostly valid values, sometimes the worst ones. Beyond the last byte everything is the default.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>

namespace lancer_fuzz {

class Bytes {
public:
  Bytes(const uint8_t *data, size_t size) : at_(data), end_(data + size) {}

  bool any() const { return at_ != end_; }
  uint8_t byte() { return any() ? *at_++ : 0; }
  uint32_t word() {
    uint32_t bits = 0;
    for (int i = 0; i < 4; ++i)
      bits = bits << 8 | byte();
    return bits;
  }
  // Returns 0 ... count - 1.
  uint32_t below(uint32_t count) { return byte() % count; }
  // Returns true with this frequency out of 256.
  bool rarely(uint32_t times) { return 255u - byte() < times; }
  // Returns a choice out of count, rarely one beyond.
  uint32_t choice(uint32_t count) {
    const uint8_t b = byte();
    return b == 255 ? count : b == 254 ? ~0u : b % count;
  }
  // Returns the number of one of count objects, rarely of one that does not exist.
  uint32_t reference(size_t count) {
    const uint8_t b = byte();
    return b >= 250 || count == 0 ? (b == 255 ? ~0u : b) : uint32_t(b % count);
  }
  // Returns usual for byte 0; otherwise uniform between low and high; rarely an extreme, or any float.
  float number(float usual, float low, float high) {
    const uint8_t b = byte();
    if (b == 0)
      return usual;
    if (b < kExtremes)
      return low + (high - low) * float(b - 1) / float(kExtremes - 2);
    if (b == 255)
      return std::bit_cast<float>(word());
    return kWorst[(b - kExtremes) % std::size(kWorst)];
  }
  double number(double usual, double low, double high) {
    const uint8_t b = byte();
    if (b == 0)
      return usual;
    if (b < kExtremes)
      return low + (high - low) * double(b - 1) / double(kExtremes - 2);
    if (b == 255)
      return double(std::bit_cast<float>(word()));
    if (b == 254)
      return kBeyondFloat[below(uint32_t(std::size(kBeyondFloat)))];
    return double(kWorst[(b - kExtremes) % std::size(kWorst)]);
  }

private:
  static constexpr uint8_t kExtremes = 220;
  static constexpr float kWorst[] = {0.0f,
                                     -0.0f,
                                     1.0f,
                                     -1.0f,
                                     0.5f,
                                     1e-7f,
                                     2e-5f,
                                     1.0000001f,
                                     0.99999994f,
                                     1e-3f,
                                     1e3f,
                                     1e10f,
                                     -1e10f,
                                     1e19f,
                                     1e30f,
                                     -1e30f,
                                     1e-30f,
                                     3.1415927f,
                                     1e38f,
                                     std::numeric_limits<float>::min(),
                                     std::numeric_limits<float>::denorm_min(),
                                     std::numeric_limits<float>::max(),
                                     std::numeric_limits<float>::lowest(),
                                     std::numeric_limits<float>::infinity(),
                                     -std::numeric_limits<float>::infinity(),
                                     std::numeric_limits<float>::quiet_NaN(),
                                     -std::numeric_limits<float>::quiet_NaN()};
  static constexpr double kBeyondFloat[] = {
      1e100, -1e100, 1e-100, 1e300, std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min()};

  const uint8_t *at_, *end_;
};

} // namespace lancer_fuzz
