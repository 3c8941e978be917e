#include "accel/bvh_accelerator.h"

#include "accel/bvh_build.h"
#include "accel/bvh_kernel.h"
#include "accel/parallel.h"
#include "accel/placed_scene.h"

#include <cstdlib>
#include <string_view>

namespace lancer {
namespace {

// The best kernel that this processor runs, or the lesser one that LANCER_ISA asks for.
const BvhKernel &choose_kernel() {
#if defined(__x86_64__)
  const char *asked = std::getenv("LANCER_ISA");
  const std::string_view limit = asked ? asked : "";
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  if (avx512 && limit != "avx2" && limit != "sse4")
    return avx512::kernel;
  if (avx2 && limit != "sse4")
    return avx2::kernel;
  return sse4::kernel;
#else
  return generic::kernel;
#endif
}

class BvhAccelerator final : public Accelerator {
public:
  BvhAccelerator(const Geometry &geometry, const BuildContext &context)
      : kernel(choose_kernel()), placed(place_scene(geometry)), meshes(geometry.meshes.size()) {
    build_meshes(geometry, context);
    build_top(context);

    for (const MeshBvh &mesh : meshes)
      views.push_back(mesh.view());
    scene = {placed.world,
             placed.shapes.data(),
             views.data(),
             top.nodes.empty() ? nullptr : top.nodes.data(),
             top.order.data(),
             placed.unbounded.data(),
             static_cast<uint32_t>(placed.unbounded.size())};
  }
  BvhAccelerator(const BvhAccelerator &) = delete;
  BvhAccelerator &operator=(const BvhAccelerator &) = delete;

  void closest_hit(std::span<const Ray> rays, std::span<Hit> hits) const override {
    kernel.closest(scene, rays.data(), hits.data(), rays.size());
  }
  void any_hit(std::span<const Ray> rays, std::span<uint8_t> occluded) const override {
    kernel.any(scene, rays.data(), occluded.data(), rays.size());
  }
  size_t bytes() const override {
    size_t sum = placed.bytes() + views.capacity() * sizeof(BvhView) + top.nodes.capacity() * sizeof(BvhNode) +
                 top.order.capacity() * sizeof(uint32_t);
    for (const MeshBvh &mesh : meshes)
      sum += mesh.bytes();
    return sum;
  }
  const char *instruction_set() const override { return kernel.name; }

private:
  // Large meshes one after the other, each on all threads; then the small ones side by side.
  void build_meshes(const Geometry &geometry, const BuildContext &context) {
    constexpr size_t kLarge = 65536;
    std::vector<uint32_t> small;
    for (uint32_t i = 0; i < meshes.size(); ++i) {
      if (geometry.meshes[i].triangles.size() < kLarge)
        small.push_back(i);
      else
        meshes[i] = build_mesh_bvh(geometry.meshes[i], placed.mesh_frames[i], context);
    }
    const BuildContext alone{1, context.cancel};
    parallel_for(context, small.size(), [&](size_t i) {
      const uint32_t mesh = small[i];
      meshes[mesh] = build_mesh_bvh(geometry.meshes[mesh], placed.mesh_frames[mesh], alone);
    });
  }

  void build_top(const BuildContext &context) {
    // A tree over so few instances sorts out less than it costs.
    if (placed.bounded.size() <= 2) {
      placed.unbounded.insert(placed.unbounded.end(), placed.bounded.begin(), placed.bounded.end());
      return;
    }
    std::vector<BuildRef> refs;
    for (size_t i = 0; i < placed.bounded.size(); ++i)
      refs.emplace_back(placed.boxes[i], placed.bounded[i]);
    top = build_wide_tree(std::move(refs), 1, context);
  }

  const BvhKernel &kernel;
  PlacedScene placed;
  std::vector<MeshBvh> meshes;
  std::vector<BvhView> views;
  WideTree top;
  BvhScene scene;
};

} // namespace

std::unique_ptr<Accelerator> build_bvh(const Geometry &geometry, const BuildContext &context) {
  return std::make_unique<BvhAccelerator>(geometry, context);
}

} // namespace lancer
