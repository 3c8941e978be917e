#include "integrator/classic.h"
#include "integrator/normals.h"
#include "integrator/path.h"

namespace lancer {

void record_first_surface(const Scene &scene, const Surface &surface, const glm::vec3 &albedo, double depth,
                          SampleResult &result) {
  result.normal = surface.ns;
  result.albedo = albedo;
  result.depth = float(depth / scene.normalisation.scale);
  result.position = glm::vec3(scene.normalisation.to_world(surface.p));
  result.object_index = float(scene.geometry.instances[surface.instance].object_index);
  if (surface.material != kNone)
    result.material_index = float(scene.materials[surface.material].index);
}

std::unique_ptr<Integrator> make_integrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings) {
  switch (settings.kind) {
  case IntegratorKind::Classic:
    return std::make_unique<ClassicIntegrator>(scene, camera, settings);
  case IntegratorKind::Normals:
    return std::make_unique<NormalsIntegrator>(scene, camera, settings);
  case IntegratorKind::Path:
    break;
  }
  return make_path(scene, camera, settings);
}

} // namespace lancer
