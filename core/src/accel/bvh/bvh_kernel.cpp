// Queries of the wide BVH in scenes in which nothing moves: trace.h, compiled once per instruction set, with LANCER_ISA as its
// name. All copies give the same bits, because no operation is contracted and boxes only cull. This file must emit no shared
// (weak) symbol: the linker would keep one translation unit's copy for all instruction sets. So it uses plain structs and
// forced inlining, and every inline function of another header must be inlined.
#include "accel/bvh/trace.h"
#include "simd/processor.h"

namespace lancer {
namespace {

[[gnu::flatten]] void closest(const BvhScene &scene, const Ray *rays, Hit *hits, size_t count) {
  trace<Question{}>(scene, rays, hits, nullptr, count, nullptr, nullptr);
}

[[gnu::flatten]] void any_hit(const BvhScene &scene, const Ray *rays, uint8_t *occluded, size_t count) {
  trace<Question{.any = true}>(scene, rays, nullptr, occluded, count, nullptr, nullptr);
}

[[gnu::flatten]] void closest_filtered(const BvhScene &scene, const Ray *rays, Hit *hits, size_t count, HitFilter &filter) {
  trace<Question{.filtered = true}>(scene, rays, hits, nullptr, count, &filter, nullptr);
}

[[gnu::flatten]] void any_filtered(const BvhScene &scene, const Ray *rays, uint8_t *occluded, size_t count, HitFilter &filter) {
  trace<Question{.any = true, .filtered = true}>(scene, rays, nullptr, occluded, count, &filter, nullptr);
}

[[gnu::flatten]] void count_work(const BvhScene &scene, const Ray *rays, size_t count, bool any, TraversalCounts &counts) {
  if (any)
    trace<Question{.any = true, .counted = true}>(scene, rays, nullptr, nullptr, count, nullptr, &counts);
  else
    trace<Question{.counted = true}>(scene, rays, nullptr, nullptr, count, nullptr, &counts);
}

} // namespace

namespace LANCER_ISA {
const BvhKernel bvh_kernel = {LANCER_ISA_NAME, closest, any_hit, closest_filtered, any_filtered, count_work};
}

} // namespace lancer
