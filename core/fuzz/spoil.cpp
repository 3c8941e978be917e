#include "spoil.h"

#include "lancer.h"
#include "render/checksum.h"
#include "render/parts.h"

#include <algorithm>
#include <cstring>

namespace lancer_fuzz {

namespace {

// The places of a part, as lancer.h documents them.
constexpr size_t kSize = 16, kDescription = 24, kTotals = kDescription + sizeof(lancer_part),
                 kTiles = kTotals + 4 * sizeof(uint64_t) + 3 * 32 * sizeof(int64_t), kChecksum = sizeof(uint64_t);

constexpr uint32_t kWorst[] = {0,           1,           2,           31,          32,          33,  63,  64,         65,
                               0x3fffffffu, 0x40000000u, 0x7fffffffu, 0x80000000u, 0xffffffffu, 255, 256, 0x7f800000u};
constexpr uint64_t kWorstLong[] = {0,
                                   1,
                                   uint64_t(1) << 31,
                                   uint64_t(1) << 60,
                                   (uint64_t(1) << 60) + 1,
                                   ~uint64_t(0),
                                   uint64_t(1) << 63,
                                   (uint64_t(1) << 63) - 1,
                                   0 - (uint64_t(1) << 60)};

// Returns a place of a number of this size: in the head, the description, the totals, at the start of the tiles, or anywhere.
size_t place_in(const std::vector<uint8_t> &part, size_t size, Bytes &bytes) {
  const size_t starts[] = {0,
                           kDescription,
                           kDescription + offsetof(lancer_part, camera),
                           kDescription + offsetof(lancer_part, settings),
                           kDescription + offsetof(lancer_part, split_lights),
                           kTotals,
                           kTiles,
                           kTiles,
                           0};
  const uint32_t which = bytes.below(uint32_t(std::size(starts)));
  const size_t offset = which + 1 < std::size(starts) ? size_t(bytes.byte()) * 4 : bytes.word();
  return part.size() < size ? 0 : (starts[which] + offset) % (part.size() - size + 1);
}

template <class Number> void put(std::vector<uint8_t> &part, Number number, Bytes &bytes) {
  const size_t at = place_in(part, sizeof number, bytes);
  if (part.size() >= sizeof number)
    std::memcpy(part.data() + at, &number, sizeof number);
}

void edit(std::vector<uint8_t> &part, Bytes &bytes) {
  switch (bytes.below(8)) {
  case 0: {
    const auto flipped = uint8_t(1u << bytes.below(8));
    const size_t at = place_in(part, 1, bytes);
    if (!part.empty())
      part[at] ^= flipped;
    return;
  }
  case 1:
    return put(part, kWorst[bytes.below(uint32_t(std::size(kWorst)))], bytes);
  case 2:
    return put(part, kWorstLong[bytes.below(uint32_t(std::size(kWorstLong)))], bytes);
  case 3:
    return put(part, bytes.number(1.0f, 0.0f, 100.0f), bytes);
  case 4:
    return put(part, bytes.number(1.0, 0.0, 100.0), bytes);
  case 5:
    return put(part, uint32_t(bytes.byte()), bytes);
  case 6: {
    // Bytes that are missing, or twice there.
    const size_t at = place_in(part, 1, bytes), count = std::min<size_t>(4 * size_t(bytes.byte()), part.size() - at);
    const auto from = part.begin() + ptrdiff_t(at);
    if (bytes.rarely(128))
      part.erase(from, from + ptrdiff_t(count));
    else {
      const std::vector<uint8_t> copy(from, from + ptrdiff_t(count));
      part.insert(from, copy.begin(), copy.end());
    }
    return;
  }
  default:
    // The end is missing.
    part.resize(part.size() - std::min<size_t>(part.size(), bytes.rarely(128) ? bytes.byte() : place_in(part, 1, bytes)));
  }
}

// Makes size, hash and checksum right, each rarely not.
void seal(std::vector<uint8_t> &part, Bytes &bytes) {
  if (part.size() < kTiles + kChecksum)
    return;
  const auto put_long = [&](size_t at, uint64_t number) { std::memcpy(part.data() + at, &number, sizeof number); };
  if (!bytes.rarely(10))
    put_long(kSize, part.size());
  if (!bytes.rarely(10)) {
    lancer_part description;
    std::memcpy(&description, part.data() + kDescription, sizeof description);
    lancer::Identity identity{{}, true, description.camera, description.settings};
    std::copy_n(description.digest, identity.digest.size(), identity.digest.begin());
    std::copy_n(description.release, identity.release.size(), identity.release.begin());
    put_long(kDescription + offsetof(lancer_part, hash), identity.hash());
  }
  if (!bytes.rarely(10))
    put_long(part.size() - kChecksum, lancer::checksum(part.data(), part.size() - kChecksum));
}

} // namespace

void spoil(std::vector<uint8_t> &part, Bytes &bytes) {
  const uint32_t edits = 1 + bytes.below(3);
  for (uint32_t i = 0; i < edits; ++i)
    edit(part, bytes);
  if (!bytes.rarely(40))
    seal(part, bytes);
}

} // namespace lancer_fuzz
