#include "accel/coplanar/coplanar_faces.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// Maximum number of cells of a face's grid along an axis.
constexpr int kLongestSide = 128;
// A cell with more patches than this counts as covered everywhere.
constexpr uint32_t kLooked = 64;
// Half a cell, padded for rounding.
constexpr double kWider = 0.5 + 0x1p-20;
// Maximum mean number of grid entries per patch.
constexpr size_t kShare = 32;

} // namespace

CoverPatch make_patch(const FaceCoordinates &coordinates, const glm::dvec3 face[3], const glm::dvec3 other[3], double border) {
  // Find the map from the face's coordinates to the world.
  const glm::dvec2 own[3] = {coordinates(face[0]), coordinates(face[1]), coordinates(face[2])};
  const glm::dvec3 a = face[1] - face[0], b = face[2] - face[0];
  const glm::dmat2 to_edges = glm::inverse(glm::dmat2(own[1] - own[0], own[2] - own[0]));
  // Hits store their coordinates in float: to 2^-24 of the face's size.
  const double longest = std::max({glm::length(a), glm::length(b), glm::length(b - a)});
  border += 0x1p-20 * longest;
  // Express the sides of the other triangle in these coordinates, moved outwards by the border.
  CoverPatch patch;
  const glm::dvec3 n = glm::cross(other[1] - other[0], other[2] - other[0]);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 inward = glm::normalize(glm::cross(n, other[i == 2 ? 0 : i + 1] - other[i]));
    patch.slope[i] = glm::dvec2(glm::dot(inward, a), glm::dot(inward, b)) * to_edges;
    patch.offset[i] = border + glm::dot(inward, face[0] - other[i]) - glm::dot(patch.slope[i], own[0]);
  }
  const glm::dvec2 places[3] = {coordinates(other[0]), coordinates(other[1]), coordinates(other[2])};
  const glm::dvec2 low = glm::min(own[0], glm::min(own[1], own[2])), high = glm::max(own[0], glm::max(own[1], own[2]));
  patch.low = glm::max(low, glm::min(places[0], glm::min(places[1], places[2])));
  patch.high = glm::min(high, glm::max(places[0], glm::max(places[1], places[2])));
  // The border over the least height bounds its size in these coordinates.
  const glm::dvec2 wide = border * longest / glm::length(glm::cross(a, b)) * (high - low);
  patch.low -= wide;
  patch.high += wide;
  return patch;
}

glm::ivec2 Cover::Face::cell(const glm::dvec2 &at) const {
  const glm::dvec2 scaled = (at - low) * cells_per_unit;
  const auto whole = [&](double x) { return x >= 0.0 ? x < side ? static_cast<int>(x) : side : -1; };
  return {whole(scaled.x), whole(scaled.y)};
}

void Cover::add_face(std::span<const CoverPatch> patches, const FaceCoordinates &coordinates) {
  Face face;
  face.coordinates = coordinates;
  face.low = patches[0].low;
  glm::dvec2 high = patches[0].high;
  for (const CoverPatch &patch : patches) {
    face.low = glm::min(face.low, patch.low);
    high = glm::max(high, patch.high);
  }
  const auto each_cell = [&](const CoverPatch &patch, auto &&use) {
    const glm::ivec2 low = glm::max(face.cell(patch.low), 0), top = glm::min(face.cell(patch.high), face.side - 1);
    const glm::dvec2 size = 1.0 / face.cells_per_unit;
    for (int y = low.y; y <= top.y; ++y)
      for (int x = low.x; x <= top.x; ++x)
        if (patch.meets(face.low + (glm::dvec2(x, y) + 0.5) * size, kWider * size))
          use(static_cast<size_t>(y * face.side + x));
  };
  // Choose cells of about a quarter of a patch's size if the patches lie side by side, and larger cells if they overlap.
  face.side = std::min(kLongestSide, 1 + static_cast<int>(4.0 * std::sqrt(static_cast<double>(patches.size()))));
  std::vector<uint32_t> counts;
  for (;; face.side /= 2) {
    face.cells_per_unit = double(face.side) / (high - face.low);
    counts.assign(static_cast<size_t>(face.side * face.side), 0);
    size_t all = 0;
    for (const CoverPatch &patch : patches)
      each_cell(patch, [&](size_t cell) { ++counts[cell], ++all; });
    if (face.side == 1 || all <= kShare * patches.size())
      break;
  }
  // Sort the patches into the cells.
  face.first_cell = static_cast<uint32_t>(begins_.size());
  uint32_t next = static_cast<uint32_t>(entries_.size());
  for (const uint32_t count : counts) {
    begins_.push_back(next);
    next += count;
  }
  begins_.push_back(next);
  entries_.resize(next);
  std::vector<uint32_t> free(begins_.begin() + face.first_cell, begins_.end());
  for (const CoverPatch &patch : patches) {
    each_cell(patch, [&](size_t cell) { entries_[free[cell]++] = static_cast<uint32_t>(patches_.size()); });
    patches_.push_back(patch);
  }
  faces_.push_back(face);
}

bool Cover::may_be(const Face &face, const glm::dvec2 &at, bool to_lose) const {
  const glm::ivec2 cell = face.cell(at);
  if (cell.x < 0 || cell.x >= face.side || cell.y < 0 || cell.y >= face.side)
    return false;
  const uint32_t *const begin = &begins_[face.first_cell + static_cast<uint32_t>(cell.y * face.side + cell.x)];
  if (begin[1] - begin[0] > kLooked)
    return true;
  for (uint32_t i = begin[0]; i < begin[1]; ++i) {
    const CoverPatch &patch = patches_[entries_[i]];
    if ((patch.loses || !to_lose) && patch.has(at))
      return true;
  }
  return false;
}

size_t Cover::bytes() const {
  return faces_.capacity() * sizeof(Face) + (begins_.capacity() + entries_.capacity()) * sizeof(uint32_t) +
         patches_.capacity() * sizeof(CoverPatch);
}

} // namespace lancer
