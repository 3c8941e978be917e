// A hash of bits: reveals any difference between two machines.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace lancer_test {

// Fowler, Noll, Vo, "FNV-1a", over bytes, the lowest of each number first.
class BitsHash {
public:
  void add(float value) { add_bytes(std::bit_cast<uint32_t>(value), 4); }
  void add(double value) { add_bytes(std::bit_cast<uint64_t>(value), 8); }
  uint64_t value() const { return hash_; }

private:
  void add_bytes(uint64_t bits, int count) {
    for (int i = 0; i < count; ++i) {
      hash_ ^= bits >> 8 * i & 0xff;
      hash_ *= 0x100000001b3ull;
    }
  }

  uint64_t hash_ = 0xcbf29ce484222325ull;
};

} // namespace lancer_test
