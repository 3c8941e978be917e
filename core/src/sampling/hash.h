// Integer hashes: an address in, bits without visible structure out. U is a uint32_t, or lanes of them.
#pragma once

#include "simd/scalar.h"

#include <type_traits>

namespace lancer {

// A bijection of 32 bits in which every input bit flips every output bit with a probability near one half.
template <class U> LANCER_LANE constexpr U hash(U x) {
  static_assert(!std::is_signed_v<U>);
  x = x ^ (x >> 16);
  x = x * U(0x85ebca6bu);
  x = x ^ (x >> 13);
  x = x * U(0xc2b2ae35u);
  return x ^ (x >> 16);
}

// Extends the hash h of an address by one more coordinate. The order of coordinates matters; for one h no two values collide.
template <class U> LANCER_LANE constexpr U hash_combine(U h, std::type_identity_t<U> value) {
  return hash((h ^ value * U(0x9e3779b1u)) + U(0x7f4a7c15u));
}

} // namespace lancer
