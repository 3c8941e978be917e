#include "integrator/classic/flat_shading.h"

#include "compile/mesh_normals.h"

namespace lancer {

Surface surface_at_center(const Scene &scene, const Hit &hit) {
  const Instance &instance = scene.geometry.instances[hit.instance];
  const Mesh &mesh = scene.geometry.meshes[instance.mesh];
  Surface surface = surface_at(scene.geometry, scene.slots, Ray{}, center_hit(mesh, hit));
  if (mesh.centers.empty())
    return surface;
  const glm::vec3 normal = carried_normal(instance.to_object, glm::dvec3(mesh.centers[mesh.polygons[hit.primitive]].normal));
  if (normal != glm::vec3(0.0f))
    surface.ng = surface.ns = normal;
  return surface;
}

} // namespace lancer
