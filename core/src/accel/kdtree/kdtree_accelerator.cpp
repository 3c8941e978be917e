#include "accel/accelerator.h"

#include "accel/hit_tests.h"
#include "accel/kdtree/kdtree.h"
#include "accel/placed_scene.h"

#include <algorithm>

namespace lancer {
namespace {

// Costs relative to a traversal step. A triangle takes a few more operations; an instance takes a transformation and a
// traversal of its own tree.
constexpr float kTriangleCost = 1.5f;
constexpr float kInstanceCost = 8.0f;

class KdTreeAccelerator final : public Accelerator {
public:
  KdTreeAccelerator(const GeometryView &g, const BuildContext &context, MeshOwners owners)
      : geometry(g), placed(place_scene(g, owners)) {
    for (size_t m = 0; m < geometry.meshes.size(); ++m) {
      const MeshView &mesh = geometry.meshes[m];
      meshes.push_back(made_once(owner_of(owners, m), &Mesh::kd_tree, [&] {
        std::vector<Box> boxes;
        boxes.reserve(mesh.triangles.size());
        for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
          boxes.push_back(mesh.key_count ? moving_triangle_box(mesh, placed.mesh_frames[m], i).swept()
                                         : triangle_box(mesh, placed.mesh_frames[m], i));
        return build_kdtree(boxes, kTriangleCost, context);
      }));
    }
    top = build_kdtree(placed.boxes, kInstanceCost, context);
  }

  size_t bytes() const override {
    size_t sum = placed.bytes() + top.bytes();
    for (const auto &mesh : meshes)
      sum += mesh->bytes();
    return sum;
  }
  const char *instruction_set() const override { return "baseline"; }

private:
  void find(std::span<const Ray> rays, std::span<Hit> hits, HitFilter *filter) const override {
    for (size_t i = 0; i < rays.size(); ++i)
      hits[i] = intersect<false>(rays[i], {filter, i});
  }
  void find(std::span<const Ray> rays, std::span<uint8_t> occluded, HitFilter *filter) const override {
    for (size_t i = 0; i < rays.size(); ++i)
      occluded[i] = intersect<true>(rays[i], {filter, i}).valid();
  }

  template <bool any> Hit intersect(const Ray &ray, const Counting &counting) const {
    Hit best;
    ObjectRay world_ray;
    if (!enter_world(placed.world, ray, world_ray))
      return best;

    // Test unbounded instances, then the instances along the ray.
    for (const uint32_t instance : placed.unbounded)
      if (intersect_instance<any>(ray, instance, counting, best))
        return best;
    const auto limit = [&] { return box_tau_above(world_ray, placed.world.scale, std::min(ray.tmax, best.t)); };
    top.traverse(world_ray, placed.world, box_tau_below(world_ray, placed.world.scale, ray.tmin), limit,
                 [&](uint32_t item) { return intersect_instance<any>(ray, placed.bounded[item], counting, best); });
    return best;
  }

  // Returns true if the search may end.
  template <bool any> bool intersect_instance(const Ray &ray, uint32_t instance, const Counting &counting, Hit &best) const {
    if (!visible(placed.shapes[instance], ray))
      return false;
    PlacedShape moved;
    const PlacedShape &shape = shape_at(placed.shapes[instance], geometry.keys.data(), ray.time, moved);
    if (shape.mesh == kNone) {
      try_quadric(ray, shape, instance, counting, best);
      return any && best.valid();
    }
    ObjectRay object_ray;
    if (!enter_shape(shape, ray, object_ray))
      return false;
    const RayAxes axes = axes_from(longest_axis(object_ray.d));
    const ShearedRay<double> sheared = shear_ray(object_ray, axes);
    const MeshView &mesh = geometry.meshes[shape.mesh];
    const auto limit = [&] { return box_tau_above(object_ray, shape.frame.scale, std::min(ray.tmax, best.t)); };
    meshes[shape.mesh]->traverse(object_ray, shape.frame, box_tau_below(object_ray, shape.frame.scale, ray.tmin), limit,
                                 [&](uint32_t triangle) {
                                   try_triangle(ray, axes, sheared, mesh, instance, triangle, counting, best);
                                   return any && best.valid();
                                 });
    return any && best.valid();
  }

  const GeometryView geometry;
  PlacedScene placed;
  std::vector<std::shared_ptr<const KdTree>> meshes;
  KdTree top;
};

} // namespace

std::unique_ptr<Accelerator> build_kdtree_accelerator(const GeometryView &geometry, const BuildContext &context,
                                                      MeshOwners owners) {
  return std::make_unique<KdTreeAccelerator>(geometry, context, owners);
}

} // namespace lancer
