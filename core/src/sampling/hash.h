// Integer hashes: an address in, bits without visible structure out.
#pragma once

#include <cstdint>

namespace lancer {

// A bijection of 32 bits in which every input bit flips every output bit with a probability near one half.
constexpr uint32_t hash(uint32_t x) {
  x ^= x >> 16;
  x *= 0x85ebca6bu;
  x ^= x >> 13;
  x *= 0xc2b2ae35u;
  x ^= x >> 16;
  return x;
}

// Extends the hash h of an address by one more coordinate. The order of coordinates matters; for one h no two values collide.
constexpr uint32_t hash_combine(uint32_t h, uint32_t value) { return hash((h ^ value * 0x9e3779b1u) + 0x7f4a7c15u); }

} // namespace lancer
