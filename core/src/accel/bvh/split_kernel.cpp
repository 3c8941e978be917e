// Bins and moves boxes. Compiled once per instruction set, with LANCER_ISA as its name; all copies give the same trees. This
// file must emit no shared (weak) symbol: see bvh_kernel.cpp.
#include "accel/bvh/bvh.h"

#include "simd/kernel_lanes.h"
#include "simd/processor.h"
#include "simd/sorted_lanes.h"

namespace lancer {
namespace {

constexpr GrowingBox kEmpty = GrowingBox::empty();

LANCER_LANE Int4 bins_of(const Binning &binning, Float4 centroid) {
  return __builtin_convertvector((centroid - binning.origin) * binning.scale, Int4);
}

LANCER_LANE void clear(Bins &bins, uint32_t used) {
  for (uint32_t bin = 0; bin < used; ++bin) {
    for (GrowingBox &box : bins.boxes[bin])
      box = kEmpty;
    for (uint32_t &count : bins.counts[bin])
      count = 0;
  }
}

// The eight numbers of a box, in as few registers as possible.
constexpr int kWidth = kLanes < 8 ? kLanes : 8;
struct BoxLanes {
  Float<kWidth> of[8 / kWidth];
};
LANCER_LANE BoxLanes lanes_of(const float *box) {
  BoxLanes r;
  for (int i = 0; i < 8 / kWidth; ++i)
    r.of[i] = load_anywhere<kWidth>(box + i * kWidth);
  return r;
}

LANCER_LANE void grow(GrowingBox &box, const BoxLanes &by) {
  float *at = reinterpret_cast<float *>(&box);
  for (int i = 0; i < 8 / kWidth; ++i)
    store(at + i * kWidth, min(by.of[i], load_lanes<kWidth>(at + i * kWidth)));
}

LANCER_LANE void add(const BuildRef &ref, const Binning &binning, Bins &bins) {
  const BoxLanes box = lanes_of(reinterpret_cast<const float *>(&ref));
  const Int4 places = bins_of(binning, ref.centroid());
  for (int axis = 0; axis < 3; ++axis) {
    const uint32_t bin = static_cast<uint32_t>(places[axis]);
    grow(bins.boxes[bin][axis], box);
    ++bins.counts[bin][axis];
  }
}

[[gnu::flatten]] void bin(const BuildRef *refs, uint32_t count, const Binning &binning, uint32_t used, Bins &bins) {
  clear(bins, used);
  // Few boxes fill one set of bins.
  constexpr uint32_t kFew = 256;
  if (count < kFew) {
    for (uint32_t i = 0; i < count; ++i)
      add(refs[i], binning, bins);
    return;
  }
  // Many boxes fill two sets alternately, so that no box waits for the previous store.
  Bins second;
  clear(second, used);
  for (uint32_t i = 0; i + 1 < count; i += 2) {
    add(refs[i], binning, bins);
    add(refs[i + 1], binning, second);
  }
  if (count % 2 != 0)
    add(refs[count - 1], binning, bins);
  for (uint32_t i = 0; i < used; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      grow(bins.boxes[i][axis], lanes_of(reinterpret_cast<const float *>(&second.boxes[i][axis])));
      bins.counts[i][axis] += second.counts[i][axis];
    }
}

// Partitions without branches on boxes.
template <int kAxis>
[[gnu::flatten]] void move(const BuildRef *refs, uint32_t begin, uint32_t end, const Binning &given, int32_t bin, BuildRef *to,
                           uint32_t left, uint32_t right, GrowingBox centroids[2]) {
  const Binning binning = given; // a copy that no store can alias
  GrowingBox left_centroids = kEmpty, right_centroids = kEmpty;
  for (uint32_t i = begin; i < end; ++i) {
    const BuildRef ref = refs[i];
    const Float4 c = ref.centroid();
    const uint32_t mask = -static_cast<uint32_t>(bins_of(binning, c)[kAxis] >= bin);
    to[(left & ~mask) | (right & mask)] = ref;
    left += mask + 1;
    right -= mask;
    // A lane with all bits set is NaN, which min ignores.
    const Int4 bits = __builtin_bit_cast(Int4, c), lost = Int4{} + static_cast<int32_t>(mask);
    const Float4 on_left = __builtin_bit_cast(Float4, bits | lost), on_right = __builtin_bit_cast(Float4, bits | ~lost);
    left_centroids = {lancer::min4(on_left, left_centroids.lo), lancer::min4(-on_left, left_centroids.minus_hi)};
    right_centroids = {lancer::min4(on_right, right_centroids.lo), lancer::min4(-on_right, right_centroids.minus_hi)};
  }
  centroids[0] = left_centroids;
  centroids[1] = right_centroids;
}

} // namespace

namespace LANCER_ISA {
const SplitKernel split_kernel = {bin, {move<0>, move<1>, move<2>}};
}

} // namespace lancer
