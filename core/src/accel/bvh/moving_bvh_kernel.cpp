// Queries of the wide BVH in scenes in which something moves; see bvh_kernel.cpp.
#include "accel/bvh/trace.h"
#include "simd/processor.h"

namespace lancer {
namespace {

[[gnu::flatten]] void closest(const BvhScene &scene, const Ray *rays, Hit *hits, size_t count) {
  trace<Question{.moving = true}>(scene, rays, hits, nullptr, count, nullptr, nullptr);
}

[[gnu::flatten]] void any_hit(const BvhScene &scene, const Ray *rays, uint8_t *occluded, size_t count) {
  trace<Question{.any = true, .moving = true}>(scene, rays, nullptr, occluded, count, nullptr, nullptr);
}

[[gnu::flatten]] void closest_filtered(const BvhScene &scene, const Ray *rays, Hit *hits, size_t count, HitFilter &filter) {
  trace<Question{.filtered = true, .moving = true}>(scene, rays, hits, nullptr, count, &filter, nullptr);
}

[[gnu::flatten]] void any_filtered(const BvhScene &scene, const Ray *rays, uint8_t *occluded, size_t count, HitFilter &filter) {
  trace<Question{.any = true, .filtered = true, .moving = true}>(scene, rays, nullptr, occluded, count, &filter, nullptr);
}

[[gnu::flatten]] void count_work(const BvhScene &scene, const Ray *rays, size_t count, bool any, TraversalCounts &counts) {
  if (any)
    trace<Question{.any = true, .counted = true, .moving = true}>(scene, rays, nullptr, nullptr, count, nullptr, &counts);
  else
    trace<Question{.counted = true, .moving = true}>(scene, rays, nullptr, nullptr, count, nullptr, &counts);
}

} // namespace

namespace LANCER_ISA {
const BvhKernel moving_bvh_kernel = {LANCER_ISA_NAME, closest, any_hit, closest_filtered, any_filtered, count_work};
}

} // namespace lancer
