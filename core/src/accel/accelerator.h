// Ray intersection. One interface, three kinds: brute force, kd-tree, wide BVH. commit() wraps each kind in the priority order
// of coplanar/coplanar_faces.h where the scene has faces in one plane.
#pragma once

#include "scene/geometry.h"
#include "scene/ray.h"
#include "simd/parallel.h"

#include <memory>
#include <span>

namespace lancer {

enum class AcceleratorKind : uint32_t { Bvh = 0, KdTree = 1, BruteForce = 2 };

// Intersects batches of rays. Immutable, so that any number of threads may use it at once. All kinds return the same hits, bit
// for bit: a hit depends on ray and primitive only, and closer() decides between hits of equal t, but for coplanar faces.
class Accelerator {
public:
  virtual ~Accelerator() = default;
  // Sets hits[i] to the closest hit of rays[i], or to an invalid Hit.
  void closest_hit(std::span<const Ray> rays, std::span<Hit> hits) const { find(rays, hits, nullptr); }
  // Sets occluded[i] to 1 if rays[i] hits anything, else to 0.
  void any_hit(std::span<const Ray> rays, std::span<uint8_t> occluded) const { find(rays, occluded, nullptr); }
  // The same queries over the hits that pass a filter.
  void closest_hit(std::span<const Ray> rays, std::span<Hit> hits, HitFilter &filter) const { find(rays, hits, &filter); }
  void any_hit(std::span<const Ray> rays, std::span<uint8_t> occluded, HitFilter &filter) const {
    find(rays, occluded, &filter);
  }
  // Returns the accelerator of the same geometry without the priority order of coplanar faces.
  virtual const Accelerator &without_order() const { return *this; }
  // Counts the work of closest_hit() or any_hit() on these rays; zeros unless this is the wide BVH.
  virtual TraversalCounts count(std::span<const Ray>, [[maybe_unused]] bool any) const { return {}; }
  virtual size_t bytes() const = 0;
  // The instruction set of the traversal's code, e.g. "AVX2".
  virtual const char *instruction_set() const = 0;

private:
  // filter: null if every hit counts.
  virtual void find(std::span<const Ray> rays, std::span<Hit> hits, HitFilter *filter) const = 0;
  virtual void find(std::span<const Ray> rays, std::span<uint8_t> occluded, HitFilter *filter) const = 0;
};

// The data that geometry refers to must outlive the accelerator. owners: keep the trees of their meshes for other scenes.
std::unique_ptr<Accelerator> build_accelerator(AcceleratorKind kind, const GeometryView &geometry, const BuildContext &context,
                                               MeshOwners owners = {});

// The builders of each kind follow. A tree of instances over one wide tree per mesh. The environment variable LANCER_ISA
// (scalar, sse4, avx2, avx512) selects a smaller instruction set than the processor has.
std::unique_ptr<Accelerator> build_bvh(const GeometryView &geometry, const BuildContext &context, MeshOwners owners = {});
// A kd-tree of instances over one kd-tree per mesh.
std::unique_ptr<Accelerator> build_kdtree_accelerator(const GeometryView &geometry, const BuildContext &context,
                                                      MeshOwners owners = {});
// Every ray against every primitive: the reference for the other accelerators.
std::unique_ptr<Accelerator> build_brute_force(const GeometryView &geometry);

} // namespace lancer
