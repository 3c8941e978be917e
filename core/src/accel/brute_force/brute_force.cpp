#include "accel/accelerator.h"

#include "accel/hit_tests.h"
#include "accel/placed_scene.h"

namespace lancer {
namespace {

class BruteForce final : public Accelerator {
public:
  explicit BruteForce(const GeometryView &g) : geometry(g), scene(place_scene(g)) {}

  size_t bytes() const override { return scene.bytes(); }
  const char *instruction_set() const override { return "baseline"; }

private:
  void find(std::span<const Ray> rays, std::span<Hit> hits, HitFilter *filter) const override {
    for (size_t i = 0; i < rays.size(); ++i)
      hits[i] = closest(rays[i], {filter, i});
  }
  void find(std::span<const Ray> rays, std::span<uint8_t> occluded, HitFilter *filter) const override {
    for (size_t i = 0; i < rays.size(); ++i)
      occluded[i] = closest(rays[i], {filter, i}).valid();
  }

  Hit closest(const Ray &ray, const Counting &counting) const {
    Hit best;
    ObjectRay world_ray;
    if (!enter_world(scene.world, ray, world_ray))
      return best;
    for (uint32_t instance = 0; instance < scene.shapes.size(); ++instance) {
      if (!visible(scene.shapes[instance], ray))
        continue;
      PlacedShape moved;
      const PlacedShape &shape = shape_at(scene.shapes[instance], geometry.keys.data(), ray.time, moved);
      if (shape.mesh == kNone) {
        try_quadric(ray, shape, instance, counting, best);
        continue;
      }
      ObjectRay object_ray;
      if (!enter_shape(shape, ray, object_ray))
        continue;
      const RayAxes axes = axes_from(longest_axis(object_ray.d));
      const ShearedRay<double> sheared = shear_ray(object_ray, axes);
      const MeshView &mesh = geometry.meshes[shape.mesh];
      for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
        try_triangle(ray, axes, sheared, mesh, instance, triangle, counting, best);
    }
    return best;
  }

  const GeometryView geometry;
  PlacedScene scene;
};

} // namespace

std::unique_ptr<Accelerator> build_brute_force(const GeometryView &geometry) { return std::make_unique<BruteForce>(geometry); }

} // namespace lancer
