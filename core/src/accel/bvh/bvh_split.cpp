#include "accel/bvh/bvh_build.h"

#include "simd/parallel.h"

#include <array>
#include <utility>
#include <vector>

namespace lancer {

const SplitKernel &split_kernel() { return LANCER_CHOSEN_KERNEL(split_kernel); }

namespace {

// Boxes that one thread bins or moves at a time.
constexpr uint32_t kPiece = 32768;

// Returns a small number of bins for small ranges, where a sweep over many bins would cost more than binning the boxes.
uint32_t bin_count(uint32_t refs) { return std::min(kMaxBins, 4 + refs / 4); }

Binning make_binning(const Box &centroids, uint32_t bins) {
  Binning binning{centroids.lo, {}};
  binning.origin[3] = 1.0f; // absorbs the value of the free lane
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = centroids.hi[axis] - centroids.lo[axis];
    const float s = static_cast<float>(bins) * 0.999999f / extent;
    binning.scale[axis] = s < Box::kInf ? s : 0.0f;
  }
  return binning;
}

Int4 counts_of(const Bins &bins, uint32_t bin) { return std::bit_cast<Int4>(std::to_array(bins.counts[bin])); }

void add(const Bins &bins, uint32_t used, Bins &sum) {
  for (uint32_t bin = 0; bin < used; ++bin)
    for (int axis = 0; axis < 3; ++axis) {
      sum.boxes[bin][axis].grow(bins.boxes[bin][axis]);
      sum.counts[bin][axis] += bins.counts[bin][axis];
    }
}

struct Plane {
  int axis = -1;
  int32_t bin = 0; // first bin of the right side
};

// Returns the cost of a side along each of the three axes; NaN for an empty side.
Float4 cost(const GrowingBox boxes[3], Int4 counts, uint32_t group) {
  // The sizes are negative; the signs cancel in their products.
  const Float4 a = boxes[0].lo + boxes[0].minus_hi, b = boxes[1].lo + boxes[1].minus_hi, c = boxes[2].lo + boxes[2].minus_hi;
  const Float4 x{a[0], b[0], c[0], 0.0f}, y{a[1], b[1], c[1], 0.0f}, z{a[2], b[2], c[2], 0.0f};
  const Int4 tests = group == 4 ? (counts + 3) >> 2 : counts;
  return (x * y + y * z + z * x) * __builtin_convertvector(tests, Float4);
}

// Sweeps the planes between the bins from both sides, along all axes at once.
Plane find_plane(const Bins &bins, uint32_t used, uint32_t group) {
  Float4 right_cost[kMaxBins];
  constexpr GrowingBox kEmpty = GrowingBox::empty();
  GrowingBox right[3] = {kEmpty, kEmpty, kEmpty}, left[3] = {kEmpty, kEmpty, kEmpty};
  Int4 right_count{}, left_count{};
  for (uint32_t bin = used - 1; bin > 0; --bin) {
    for (int axis = 0; axis < 3; ++axis)
      right[axis].grow(bins.boxes[bin][axis]);
    right_count += counts_of(bins, bin);
    right_cost[bin] = cost(right, right_count, group);
  }
  Float4 best{Box::kInf, Box::kInf, Box::kInf, Box::kInf};
  Int4 best_bin{};
  for (uint32_t bin = 1; bin < used; ++bin) {
    for (int axis = 0; axis < 3; ++axis)
      left[axis].grow(bins.boxes[bin - 1][axis]);
    left_count += counts_of(bins, bin - 1);
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

} // namespace

BuildRange RangeSplitter::all(uint32_t count) const {
  std::vector<BuildRange> pieces((count + kPiece - 1) / kPiece);
  parallel_for(context, pieces.size(), [&](size_t piece) {
    BuildRange part; // local to the thread's stack
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
  const Binning binning = make_binning(range.centroids, used);
  const auto piece_begin = [&](size_t piece) { return range.begin + static_cast<uint32_t>(piece) * kPiece; };
  const auto piece_end = [&](size_t piece) { return std::min(piece_begin(piece) + kPiece, range.end); };
  Bins sum;
  std::vector<Bins> piece_bins(pieces > 1 ? pieces : 0);
  if (pieces == 1) {
    kernel.bin(from + range.begin, range.count(), binning, used, sum);
  } else {
    parallel_for(context, pieces, [&](size_t piece) {
      kernel.bin(from + piece_begin(piece), piece_end(piece) - piece_begin(piece), binning, used, piece_bins[piece]);
    });
    sum = piece_bins[0];
    for (uint32_t piece = 1; piece < pieces; ++piece)
      add(piece_bins[piece], used, sum);
  }

  const Plane plane = find_plane(sum, used, group);
  if (plane.axis < 0)
    return false;

  // Take the sides' boxes and sizes from the bins.
  const auto count_left = [&](const Bins &bins) {
    uint32_t count = 0;
    for (int32_t bin = 0; bin < plane.bin; ++bin)
      count += bins.counts[bin][plane.axis];
    return count;
  };
  for (int32_t bin = 0; bin < static_cast<int32_t>(used); ++bin)
    sides[bin >= plane.bin].box.grow(sum.boxes[bin][plane.axis].box());
  const uint32_t middle = range.begin + count_left(sum);
  sides[0].begin = range.begin;
  sides[0].end = sides[1].begin = middle;
  sides[1].end = range.end;
  sides[0].buffer = sides[1].buffer = range.buffer ^ 1;

  // Move the boxes to their sides.
  BuildRef *to = buffers[range.buffer ^ 1];
  const auto move = kernel.move[plane.axis];
  if (pieces == 1) {
    GrowingBox centroids[2];
    move(from, range.begin, range.end, binning, plane.bin, to, range.begin, middle, centroids);
    for (int side = 0; side < 2; ++side)
      sides[side].centroids = centroids[side].box();
    return true;
  }
  std::vector<uint32_t> lefts(pieces, range.begin);
  for (uint32_t piece = 1; piece < pieces; ++piece)
    lefts[piece] = lefts[piece - 1] + count_left(piece_bins[piece - 1]);
  std::vector<std::array<GrowingBox, 2>> centroids(pieces);
  parallel_for(context, pieces, [&](size_t piece) {
    const uint32_t begin = piece_begin(piece), right = middle + (begin - range.begin) - (lefts[piece] - range.begin);
    move(from, begin, piece_end(piece), binning, plane.bin, to, lefts[piece], right, centroids[piece].data());
  });
  for (const std::array<GrowingBox, 2> &piece : centroids)
    for (size_t side = 0; side < 2; ++side)
      sides[side].centroids.grow(piece[side].box());
  return true;
}

void RangeSplitter::split_by_count(const BuildRange &range, BuildRange sides[2]) const {
  // Halve along the widest axis; coincident centroids stay in order.
  BuildRef *r = buffers[range.buffer];
  const Float4 extent = range.centroids.hi - range.centroids.lo;
  const int axis = extent[0] >= extent[1] && extent[0] >= extent[2] ? 0 : (extent[1] >= extent[2] ? 1 : 2);
  const uint32_t middle = range.begin + range.count() / 2;
  if (extent[axis] > 0.0f) {
    // Break ties by id, and keep the order within each side: every machine builds the same tree.
    const auto key = [axis](const BuildRef &ref) { return std::pair(ref.centroid()[axis], ref.id()); };
    std::vector<std::pair<float, uint32_t>> keys;
    for (uint32_t i = range.begin; i < range.end; ++i)
      keys.push_back(key(r[i]));
    const auto first = keys.begin() + (middle - range.begin);
    std::nth_element(keys.begin(), first, keys.end());
    std::stable_partition(r + range.begin, r + range.end,
                          [&, least = *first](const BuildRef &ref) { return key(ref) < least; });
  }
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
  // Split by count if all centroids coincide or the tree is too deep.
  BuildRange sides[2];
  if (by_count || !split_by_area(range, sides))
    split_by_count(range, sides);
  for (BuildRange &side : sides)
    side.leaf = is_leaf(side);
  left = sides[0];
  right = sides[1];
}

} // namespace lancer
