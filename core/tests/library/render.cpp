// Renders through the shipped library with nothing but its header; prints the release and the picture's mean.
#include "../tiny_scene.h"

#include <cstdio>

int main() {
  using namespace lancer_test;
  const lancer_scene scene = make_scene();
  const lancer_camera camera = make_camera();
  lancer_settings settings = make_settings();
  settings.passes = 1u << LANCER_PASS_COMBINED;
  lancer_session session = 0;
  std::vector<float> image(size_t(camera.width) * camera.height * 4);
  const bool rendered = lancer_session_create(scene, &camera, &settings, &session) == LANCER_OK &&
                        lancer_session_render(session, 0, settings.samples) == LANCER_OK && finish(session) == LANCER_OK &&
                        lancer_session_read(session, LANCER_PASS_COMBINED, image.data(), image.size()) == LANCER_OK;
  double mean = 0.0;
  for (const float value : image)
    mean += double(value) / double(image.size());
  std::printf("Lancer %s: mean %.9g %s\n", lancer_version(), mean, lancer_last_error());
  // The sky alone gives a fifth, and only the lamp's own tetrahedron exceeds one.
  return rendered && mean > 0.05 && mean < 5.0 ? 0 : 1;
}
