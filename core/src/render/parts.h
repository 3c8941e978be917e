// Parts of a picture: the sums of some samples of some tiles as bytes, in the form that lancer.h documents.
#pragma once

#include "integrator/sample.h"
#include "lancer.h"
#include "render/film.h"

#include <array>
#include <cstddef>
#include <span>

namespace lancer {

// Everything that decides the bits of a picture's samples, except the splits.
struct Identity {
  std::array<uint8_t, 32> digest{}; // of the scene
  bool has_digest = false;
  lancer_camera camera{};
  lancer_settings settings{};
  std::array<char, sizeof lancer_part::release> release{}; // of this library

  // Returns the hash of the digest, the release, the camera and the settings on which bits depend.
  uint64_t hash() const;
  // Throws Error with a sentence about the first difference that changes bits. other: a part's.
  void require_same(const Identity &other) const;
};

// Figures of a part's samples beside the film.
struct Totals {
  RayCounts rays;
  uint64_t vertices = 0;
  Energy energy;

  Totals &operator+=(const Totals &other);
  Totals &operator-=(const Totals &other);
};

// Returns the size of the film's part in bytes.
size_t part_size(const Film &film);
// Writes the film's part; out has its size.
void write_part(const Film &film, const Identity &identity, const Splits &splits, const Totals &totals,
                std::span<std::byte> out);

// A part whose size and checksum are right.
class Part {
public:
  // Throws Error for bytes that are no part of this interface, or damaged. bytes must outlive the object.
  explicit Part(std::span<const std::byte> bytes);

  const lancer_part &description() const { return description_; }
  Identity identity() const;
  // Adds the samples to a film of the same picture, whose sums the part's must fit; throws Error and leaves the film unchanged
  // if they do not fit or overlap the film's, or if memory runs out. others: the totals of the parts in the film. Returns the
  // sum of these and the part's.
  Totals add_to(Film &film, const Totals &others) const;

private:
  std::span<const std::byte> bytes_;
  lancer_part description_{};
};

} // namespace lancer
