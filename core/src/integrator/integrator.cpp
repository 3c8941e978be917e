#include "integrator/aov/normals.h"
#include "integrator/classic/classic.h"
#include "integrator/path/path.h"

namespace lancer {

std::unique_ptr<Integrator> make_integrator(const Scene &scene, const Camera &camera, const IntegratorSettings &settings) {
  switch (settings.kind()) {
  case IntegratorKind::Classic:
    return std::make_unique<ClassicIntegrator>(scene, camera, settings);
  case IntegratorKind::Normals:
    return std::make_unique<NormalsIntegrator>(scene, camera, settings);
  case IntegratorKind::Path:
    break;
  }
  return std::make_unique<PathIntegrator>(scene, camera, settings);
}

} // namespace lancer
