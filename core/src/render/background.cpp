#include "render/background.h"

#include "lancer.h"

namespace lancer {

namespace {

// Below kLeastPlanned samples, the search costs more time than it saves. Projecting kProjectedEach triangles per pixel takes
// about as long as one sample of the background.
constexpr uint32_t kLeastPlanned = 8;
constexpr uint64_t kProjectedEach = 8;

} // namespace

Background find_background(const Scene &scene, const Camera &camera, const IntegratorSettings &settings, const Film &film) {
  if (settings.kind() != IntegratorKind::Path || settings.samples < kLeastPlanned || settings.all_features() ||
      !has_even_background(scene, camera))
    return Background();
  Background background;
  background.coverage = Coverage(scene, camera, settings.filter_width, kProjectedEach * film.width() * film.height());
  if (background.coverage.covers_all())
    return Background();
  const glm::uvec2 pixel = background.coverage.empty_pixel();
  const SampleAddress address{pixel.x, pixel.y, 0};
  make_integrator(scene, camera, settings)->run(std::span(&address, 1), std::span(&background.sample, 1), nullptr);
  // The film drops and counts each sample that is not finite, so a background that is not finite is traced.
  return film.finite(background.sample) ? background : Background();
}

bool has_even_background(const Scene &scene, const Camera &camera) {
  if (camera.is_panorama() || scene.lights.environment().varies())
    return false;
  for (uint32_t number = 0; number < scene.lights.lights().size(); ++number)
    if (const DescribedLight lamp = describe(scene.lights.lights()[number], number);
        lamp.met && lamp.distant() && !(scene.lights.hidden_from(number) & LANCER_RAY_CAMERA))
      return false;
  return true;
}

} // namespace lancer
