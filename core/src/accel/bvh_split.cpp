#include "accel/bvh_split.h"

#include "accel/parallel.h"

#include <array>

namespace lancer {
namespace {

constexpr uint32_t kMaxBins = 16;
// What one thread bins or moves at a time.
constexpr uint32_t kPiece = 32768;

// Small ranges are worth few bins: a sweep over them costs more than their boxes.
uint32_t bin_count(uint32_t refs) { return std::min(kMaxBins, 4 + refs / 4); }

// Maps centroids to bins, the same way in every pass.
struct Binning {
  Float4 origin, scale;

  Binning(const Box &centroids, uint32_t bins) : origin(centroids.lo), scale{} {
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = centroids.hi[axis] - centroids.lo[axis];
      const float s = static_cast<float>(bins) * 0.999999f / extent;
      scale[axis] = s < Box::kInf ? s : 0.0f;
    }
  }
  Int4 bins(Float4 centroid) const { return __builtin_convertvector((centroid - origin) * scale, Int4); }
};

// Unset until cleared: only as many as are used.
struct Bins {
  struct Bounds {
    Float4 lo, hi;
  };
  Bounds bounds[kMaxBins][3];
  alignas(16) std::array<uint32_t, 4> counts[kMaxBins];

  Box box(uint32_t bin, int axis) const { return {bounds[bin][axis].lo, bounds[bin][axis].hi}; }
  Int4 count(uint32_t bin) const { return std::bit_cast<Int4>(counts[bin]); }
  void clear(uint32_t used) {
    constexpr Box kEmpty;
    for (uint32_t bin = 0; bin < used; ++bin) {
      for (Bounds &b : bounds[bin])
        b = {kEmpty.lo, kEmpty.hi};
      counts[bin] = {};
    }
  }
  void grow(uint32_t bin, int axis, const Box &by) {
    Bounds &b = bounds[bin][axis];
    b.lo = min4(b.lo, by.lo);
    b.hi = max4(b.hi, by.hi);
  }
  void add(const BuildRef *refs, uint32_t begin, uint32_t end, const Binning &binning) {
    for (uint32_t i = begin; i < end; ++i) {
      const Box by = refs[i].box();
      const Int4 bins = binning.bins(refs[i].centroid());
      for (int axis = 0; axis < 3; ++axis) {
        const uint32_t bin = static_cast<uint32_t>(bins[axis]);
        grow(bin, axis, by);
        ++counts[bin][static_cast<size_t>(axis)];
      }
    }
  }
  void add(const Bins &other, uint32_t used) {
    for (uint32_t bin = 0; bin < used; ++bin)
      for (int axis = 0; axis < 3; ++axis) {
        grow(bin, axis, other.box(bin, axis));
        counts[bin][static_cast<size_t>(axis)] += other.counts[bin][static_cast<size_t>(axis)];
      }
  }
};

struct Plane {
  int axis = -1;
  int32_t bin = 0; // the first bin of the right side
};

// What the boxes of all three axes cost together with their primitives; not a number where there are none.
Float4 cost(const Box boxes[3], Int4 counts, uint32_t group) {
  const Float4 a = boxes[0].hi - boxes[0].lo, b = boxes[1].hi - boxes[1].lo, c = boxes[2].hi - boxes[2].lo;
  const Float4 x{a[0], b[0], c[0], 0.0f}, y{a[1], b[1], c[1], 0.0f}, z{a[2], b[2], c[2], 0.0f};
  const Int4 tests = group == 4 ? (counts + 3) >> 2 : counts;
  return (x * y + y * z + z * x) * __builtin_convertvector(tests, Float4);
}

// Sweeps the planes between the bins from both sides, along all axes at once.
Plane find_plane(const Bins &bins, uint32_t used, uint32_t group) {
  Float4 right_cost[kMaxBins];
  Box right[3], left[3];
  Int4 right_count{}, left_count{};
  for (uint32_t bin = used - 1; bin > 0; --bin) {
    for (int axis = 0; axis < 3; ++axis)
      right[axis].grow(bins.box(bin, axis));
    right_count += bins.count(bin);
    right_cost[bin] = cost(right, right_count, group);
  }
  Float4 best{Box::kInf, Box::kInf, Box::kInf, Box::kInf};
  Int4 best_bin{};
  for (uint32_t bin = 1; bin < used; ++bin) {
    for (int axis = 0; axis < 3; ++axis)
      left[axis].grow(bins.box(bin - 1, axis));
    left_count += bins.count(bin - 1);
    const Float4 sum = cost(left, left_count, group) + right_cost[bin];
    const Int4 better = sum < best;
    best = better ? sum : best;
    best_bin = (better & static_cast<int32_t>(bin)) | (~better & best_bin);
  }
  Plane plane;
  float least = Box::kInf;
  for (int axis = 0; axis < 3; ++axis)
    if (best[axis] < least) {
      least = best[axis];
      plane = {axis, best_bin[axis]};
    }
  return plane;
}

// The boxes of centroids on both sides of a plane.
using CentroidBoxes = std::array<Box, 2>;

// Moves a piece of a range to the places of its left and its right side, without branches on boxes.
template <int kAxis>
CentroidBoxes move_piece(const BuildRef *from, BuildRef *to, uint32_t begin, uint32_t end, uint32_t left, uint32_t right,
                         const Binning &binning, int32_t bin) {
  CentroidBoxes boxes;
  for (uint32_t i = begin; i < end; ++i) {
    const BuildRef ref = from[i];
    const Float4 centroid = ref.centroid();
    const int32_t on_right = -static_cast<int32_t>(binning.bins(centroid)[kAxis] >= bin);
    const uint32_t mask = static_cast<uint32_t>(on_right);
    to[(left & ~mask) | (right & mask)] = ref;
    left += mask + 1;
    right -= mask;
    // With all bits set a lane is not a number, and loses against every other.
    const Int4 bits = std::bit_cast<Int4>(centroid);
    const Int4 lost{on_right, on_right, on_right, on_right};
    const Float4 on_left_only = std::bit_cast<Float4>(bits | lost), on_right_only = std::bit_cast<Float4>(bits | ~lost);
    boxes[0].lo = min4(on_left_only, boxes[0].lo);
    boxes[0].hi = max4(on_left_only, boxes[0].hi);
    boxes[1].lo = min4(on_right_only, boxes[1].lo);
    boxes[1].hi = max4(on_right_only, boxes[1].hi);
  }
  return boxes;
}

} // namespace

BuildRange RangeSplitter::all(uint32_t count) const {
  std::vector<BuildRange> pieces((count + kPiece - 1) / kPiece);
  parallel_for(context, pieces.size(), [&](size_t piece) {
    BuildRange part; // of this thread's stack
    const uint32_t begin = static_cast<uint32_t>(piece) * kPiece;
    for (uint32_t i = begin; i < std::min(begin + kPiece, count); ++i) {
      part.box.grow(buffers[0][i].box());
      part.centroids.grow(buffers[0][i].centroid());
    }
    pieces[piece] = part;
  });
  BuildRange range;
  range.end = count;
  for (const BuildRange &piece : pieces) {
    range.box.grow(piece.box);
    range.centroids.grow(piece.centroids);
  }
  range.leaf = is_leaf(range);
  return range;
}

bool RangeSplitter::is_leaf(const BuildRange &range) const {
  if (range.count() > group)
    return false;
  const BuildRef *r = refs(range);
  for (uint32_t i = range.begin + 1; i < range.end; ++i)
    if (r[i].owner() != r[range.begin].owner() || r[i].owner() == kWholeInstance)
      return false;
  return true;
}

bool RangeSplitter::split_by_area(const BuildRange &range, BuildRange sides[2]) const {
  // Sort the boxes into bins along all three axes, piece by piece.
  const BuildRef *from = buffers[range.buffer];
  const uint32_t used = bin_count(range.count()), pieces = (range.count() + kPiece - 1) / kPiece;
  const Binning binning(range.centroids, used);
  const auto piece_end = [&](size_t piece) {
    return static_cast<uint32_t>(std::min<size_t>(range.begin + (piece + 1) * kPiece, range.end));
  };
  Bins sum;
  sum.clear(used);
  std::vector<Bins> piece_bins(pieces > 1 ? pieces : 0);
  if (pieces == 1) {
    sum.add(from, range.begin, range.end, binning);
  } else {
    parallel_for(context, pieces, [&](size_t piece) {
      piece_bins[piece].clear(used);
      piece_bins[piece].add(from, range.begin + static_cast<uint32_t>(piece) * kPiece, piece_end(piece), binning);
    });
    for (const Bins &bins : piece_bins)
      sum.add(bins, used);
  }

  const Plane plane = find_plane(sum, used, group);
  if (plane.axis < 0)
    return false;

  // The bins know the sides' boxes and sizes.
  const auto count_left = [&](const Bins &bins) {
    uint32_t count = 0;
    for (int32_t bin = 0; bin < plane.bin; ++bin)
      count += bins.counts[bin][static_cast<size_t>(plane.axis)];
    return count;
  };
  for (int32_t bin = 0; bin < static_cast<int32_t>(used); ++bin)
    sides[bin >= plane.bin].box.grow(sum.box(static_cast<uint32_t>(bin), plane.axis));
  const uint32_t middle = range.begin + count_left(sum);
  sides[0].begin = range.begin;
  sides[0].end = sides[1].begin = middle;
  sides[1].end = range.end;
  sides[0].buffer = sides[1].buffer = range.buffer ^ 1;

  // Move the boxes to their sides.
  BuildRef *to = buffers[range.buffer ^ 1];
  constexpr auto kMove = std::array{move_piece<0>, move_piece<1>, move_piece<2>};
  const auto move = kMove[static_cast<size_t>(plane.axis)];
  if (pieces == 1) {
    const CentroidBoxes boxes = move(from, to, range.begin, range.end, range.begin, middle, binning, plane.bin);
    sides[0].centroids = boxes[0];
    sides[1].centroids = boxes[1];
    return true;
  }
  std::vector<uint32_t> lefts(pieces, range.begin);
  for (uint32_t piece = 1; piece < pieces; ++piece)
    lefts[piece] = lefts[piece - 1] + count_left(piece_bins[piece - 1]);
  std::vector<CentroidBoxes> boxes(pieces);
  parallel_for(context, pieces, [&](size_t piece) {
    const uint32_t begin = range.begin + static_cast<uint32_t>(piece) * kPiece;
    const uint32_t right = middle + (begin - range.begin) - (lefts[piece] - range.begin);
    boxes[piece] = move(from, to, begin, piece_end(piece), lefts[piece], right, binning, plane.bin);
  });
  for (const CentroidBoxes &piece : boxes)
    for (int side = 0; side < 2; ++side)
      sides[side].centroids.grow(piece[static_cast<size_t>(side)]);
  return true;
}

void RangeSplitter::split_by_count(const BuildRange &range, BuildRange sides[2]) const {
  // Halve along the widest axis; coincident centroids have no order.
  BuildRef *r = buffers[range.buffer];
  const Float4 extent = range.centroids.hi - range.centroids.lo;
  const int axis = extent[0] >= extent[1] && extent[0] >= extent[2] ? 0 : (extent[1] >= extent[2] ? 1 : 2);
  const uint32_t middle = range.begin + range.count() / 2;
  if (extent[axis] > 0.0f)
    std::nth_element(r + range.begin, r + middle, r + range.end, [axis](const BuildRef &a, const BuildRef &b) {
      const float x = a.centroid()[axis], y = b.centroid()[axis];
      return x != y ? x < y : a.id() < b.id();
    });
  sides[0].begin = range.begin;
  sides[0].end = sides[1].begin = middle;
  sides[1].end = range.end;
  sides[0].buffer = sides[1].buffer = range.buffer;
  for (uint32_t i = range.begin; i < range.end; ++i) {
    sides[i >= middle].box.grow(r[i].box());
    sides[i >= middle].centroids.grow(r[i].centroid());
  }
}

void RangeSplitter::split(const BuildRange &range, bool by_count, BuildRange &left, BuildRange &right) const {
  // Where all centroids coincide, and where the tree is too deep, the count decides.
  BuildRange sides[2];
  if (by_count || !split_by_area(range, sides))
    split_by_count(range, sides);
  for (BuildRange &side : sides)
    side.leaf = is_leaf(side);
  left = sides[0];
  right = sides[1];
}

} // namespace lancer
