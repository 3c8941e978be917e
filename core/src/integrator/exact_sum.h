// A sum of floats without rounding: the same in any order, also of sums over parts of the numbers.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lancer {

// Digits of base 256 over the whole range of float, as in a long accumulator (Kulisch, "Computer arithmetic and validity",
// 2013). A digit holds 2^32 carries of one number before it overflows; sums carry whenever two of them are added.
class ExactSum {
public:
  static constexpr uint32_t kDigits = 32;

  ExactSum() = default;
  // digits: as digits() returns them.
  explicit ExactSum(const std::array<int64_t, kDigits> &digits) : digits_(digits) {}

  // value must be finite.
  ExactSum &operator+=(float value) {
    const auto bits = std::bit_cast<uint32_t>(value);
    const uint32_t exponent = bits >> 23 & 0xff;
    // The number is mantissa 2^(exponent - 150), and subnormal numbers have the exponent 1.
    const int64_t mantissa = exponent ? (bits & 0x7fffff) | 0x800000 : bits & 0x7fffff;
    const uint32_t power = exponent ? exponent : 1;
    const int64_t shifted = mantissa << (power % 8);
    digits_[power / 8] += bits >> 31 ? -shifted : shifted;
    return *this;
  }
  ExactSum &operator+=(const ExactSum &other) {
    for (uint32_t i = 0; i < kDigits; ++i)
      digits_[i] += other.digits_[i];
    carry();
    return *this;
  }
  ExactSum &operator-=(const ExactSum &other) {
    for (uint32_t i = 0; i < kDigits; ++i)
      digits_[i] -= other.digits_[i];
    carry();
    return *this;
  }
  // Returns the sum, rounded.
  double value() const {
    ExactSum sum = *this;
    sum.carry();
    double result = 0.0;
    for (uint32_t i = kDigits; i-- > 0;)
      result += std::ldexp(double(sum.digits_[i]), int(8 * i) - 150);
    return result;
  }
  // Returns the digits of the sum: all but the last are 0 ... 255.
  std::array<int64_t, kDigits> digits() const {
    ExactSum sum = *this;
    sum.carry();
    return sum.digits_;
  }

private:
  void carry() {
    for (uint32_t i = 0; i + 1 < kDigits; ++i) {
      digits_[i + 1] += digits_[i] >> 8;
      digits_[i] &= 0xff;
    }
  }

  std::array<int64_t, kDigits> digits_{};
};

} // namespace lancer
