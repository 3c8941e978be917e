// Does a ray meet the scene? One interface, three answers: brute force, kd-tree, wide BVH.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"
#include "simd/parallel.h"

#include <memory>
#include <span>

namespace lancer {

enum class AcceleratorKind : uint32_t { Bvh = 0, KdTree = 1, BruteForce = 2 };

// Answers for batches of rays; immutable, so any number of threads may ask at once.
// All kinds give the same hits, bit for bit: a hit depends on ray and primitive only, and closer() breaks ties.
class Accelerator {
public:
  virtual ~Accelerator() = default;
  // hits[i]: the closest hit of rays[i], or an invalid Hit.
  void closest_hit(std::span<const Ray> rays, std::span<Hit> hits) const { find(rays, hits, nullptr); }
  // occluded[i]: 1 where rays[i] meets anything at all.
  void any_hit(std::span<const Ray> rays, std::span<uint8_t> occluded) const { find(rays, occluded, nullptr); }
  // The same of the hits that count.
  void closest_hit(std::span<const Ray> rays, std::span<Hit> hits, const HitFilter &filter) const { find(rays, hits, &filter); }
  void any_hit(std::span<const Ray> rays, std::span<uint8_t> occluded, const HitFilter &filter) const {
    find(rays, occluded, &filter);
  }
  // The work of closest_hit() or any_hit() on these rays, counted by the wide BVH; zeros from the others.
  virtual TraversalCounts count(std::span<const Ray>, [[maybe_unused]] bool any) const { return {}; }
  virtual size_t bytes() const = 0;
  // The instruction set that the traversal was compiled for and runs with, e.g. "AVX2".
  virtual const char *instruction_set() const = 0;

private:
  // filter: null where every hit counts.
  virtual void find(std::span<const Ray> rays, std::span<Hit> hits, const HitFilter *filter) const = 0;
  virtual void find(std::span<const Ray> rays, std::span<uint8_t> occluded, const HitFilter *filter) const = 0;
};

// geometry must outlive the accelerator.
std::unique_ptr<Accelerator> build_accelerator(AcceleratorKind kind, const Geometry &geometry, const BuildContext &context);

// Each by itself:
//
// A tree of instances over one wide tree per mesh. The environment variable LANCER_ISA (scalar, sse4, avx2, avx512) forces a
// lesser instruction set than the processor has.
std::unique_ptr<Accelerator> build_bvh(const Geometry &geometry, const BuildContext &context);
// A kd-tree of instances over one per mesh.
std::unique_ptr<Accelerator> build_kdtree_accelerator(const Geometry &geometry, const BuildContext &context);
// Every ray against every primitive: the oracle that the other accelerators must equal.
std::unique_ptr<Accelerator> build_brute_force(const Geometry &geometry);

} // namespace lancer
