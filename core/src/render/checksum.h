// XXH64, the checksum of parts: Collet, "xxHash fast digest algorithm", version 0.1.1, section XXH64, with seed 0.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lancer {

inline uint64_t checksum(const void *data, size_t size) {
  static_assert(std::endian::native == std::endian::little);
  constexpr uint64_t kPrime1 = 0x9E3779B185EBCA87, kPrime2 = 0xC2B2AE3D27D4EB4F, kPrime3 = 0x165667B19E3779F9,
                     kPrime4 = 0x85EBCA77C2B2AE63, kPrime5 = 0x27D4EB2F165667C5;
  const auto *at = static_cast<const unsigned char *>(data), *const end = at + size;
  const auto next = [&]<class Number>(Number number) {
    std::memcpy(&number, at, sizeof number);
    at += sizeof number;
    return uint64_t(number);
  };
  const auto round = [&](uint64_t sum, uint64_t lane) { return std::rotl(sum + lane * kPrime2, 31) * kPrime1; };
  uint64_t hash = kPrime5;
  // Take stripes of four lanes.
  if (size >= 32) {
    uint64_t sums[4] = {kPrime1 + kPrime2, kPrime2, 0, 0 - kPrime1};
    while (end - at >= 32)
      for (uint64_t &sum : sums)
        sum = round(sum, next(uint64_t()));
    hash = std::rotl(sums[0], 1) + std::rotl(sums[1], 7) + std::rotl(sums[2], 12) + std::rotl(sums[3], 18);
    for (const uint64_t sum : sums)
      hash = (hash ^ round(0, sum)) * kPrime1 + kPrime4;
  }
  hash += size;
  // Take the rest.
  while (end - at >= 8)
    hash = std::rotl(hash ^ round(0, next(uint64_t())), 27) * kPrime1 + kPrime4;
  if (end - at >= 4)
    hash = std::rotl(hash ^ next(uint32_t()) * kPrime1, 23) * kPrime2 + kPrime3;
  while (at < end)
    hash = std::rotl(hash ^ next(uint8_t()) * kPrime5, 11) * kPrime1;
  // Mix all bits.
  hash = (hash ^ hash >> 33) * kPrime2;
  hash = (hash ^ hash >> 29) * kPrime3;
  return hash ^ hash >> 32;
}

} // namespace lancer
