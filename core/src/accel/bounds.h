// Float boxes for building trees, in four lanes.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace lancer {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

#if defined(__SSE2__)
inline Float4 min4(Float4 a, Float4 b) { return Float4(_mm_min_ps(__m128(a), __m128(b))); }
inline Float4 max4(Float4 a, Float4 b) { return Float4(_mm_max_ps(__m128(a), __m128(b))); }
#else
inline Float4 min4(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max4(Float4 a, Float4 b) { return a > b ? a : b; }
#endif

// Padding of boxes in their frame, where coordinates are at most 1. The slab test of bvh_kernel.cpp works in float, u = 2^-24,
// as b / d - q / d; a ray that hits the contents starts within sqrt(3) of the centre (placed_shape.h), so b - q is at most
// 2.74. The errors, as displacements of the box's planes, are: rounding of q 1.74u; of b 0.5u; of both products 1.74u and 1u;
// of the difference 2.74u; of the direction and its inverse 2 * 2.74u. The sum is 13.2u < 16u = 2^-20.
inline constexpr float kBoxPad = 0x1p-20f;

// Additional padding of a box whose sides move, as lo + time * (hi - lo) in float: the difference, the product and the sum
// round numbers of at most 2, 2 and 1, by 5u in all.
inline constexpr float kMovingPad = 0x1p-21f;

// Lane 3 is free for the builder; it takes part in min and max, but its result has no meaning.
struct Box {
  Float4 lo{kInf, kInf, kInf, kInf};
  Float4 hi{-kInf, -kInf, -kInf, -kInf};

  void grow(const Box &b) {
    lo = min4(lo, b.lo);
    hi = max4(hi, b.hi);
  }
  void grow(Float4 p) {
    lo = min4(lo, p);
    hi = max4(hi, p);
  }
  // Returns half the surface area; 0 for an empty box.
  float half_area() const {
    const Float4 d = hi - lo;
    return d[0] >= 0.0f ? d[0] * d[1] + d[1] * d[2] + d[2] * d[0] : 0.0f;
  }
  // Returns twice the centroid.
  Float4 centroid() const { return lo + hi; }

  static constexpr float kInf = std::numeric_limits<float>::infinity();
};

// A box whose high corner is stored negated, so that both corners grow by minima.
struct GrowingBox {
  Float4 lo, minus_hi;

  static constexpr GrowingBox empty() {
    constexpr Box kEmpty;
    return {kEmpty.lo, kEmpty.lo};
  }
  void grow(const GrowingBox &b) {
    lo = min4(lo, b.lo);
    minus_hi = min4(minus_hi, b.minus_hi);
  }
  Box box() const { return {lo, -minus_hi}; }
};

// A box with an id and an owner in its free lanes: 32 bytes.
struct BuildRef {
  Float4 lo, minus_hi;

  BuildRef() = default;
  BuildRef(const Box &box, uint32_t id, uint32_t owner = 0) : lo(box.lo), minus_hi(-box.hi) {
    lo[3] = std::bit_cast<float>(id);
    minus_hi[3] = std::bit_cast<float>(owner);
  }
  uint32_t id() const { return static_cast<uint32_t>(std::bit_cast<Int4>(lo)[3]); }
  uint32_t owner() const { return static_cast<uint32_t>(std::bit_cast<Int4>(minus_hi)[3]); }
  Box box() const { return {lo, -minus_hi}; }
  // Returns twice the centroid, which decides splits. The free lane is cleared, because ids read as floats are denormal and
  // slow.
  [[gnu::always_inline]] Float4 centroid() const {
    constexpr Int4 kAxes{-1, -1, -1, 0};
    return std::bit_cast<Float4>(std::bit_cast<Int4>(lo - minus_hi) & kAxes);
  }
};

} // namespace lancer
