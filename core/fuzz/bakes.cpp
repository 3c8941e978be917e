#include "bakes.h"

#include "checked.h"

namespace lancer_fuzz {

namespace {

constexpr uint32_t kMostTriangle = 20;

} // namespace

SessionState bake(lancer_scene scene, const Filled *filled, Records &records, Bytes &bytes) {
  SessionState session{0, records.camera(), records.settings()};
  lancer_camera &camera = session.camera;
  // Texels are those of the whole picture.
  if (!bytes.rarely(10)) {
    camera.x = camera.y = 0;
    camera.width = camera.region_width;
    camera.height = camera.region_height;
  }
  if (!bytes.rarely(10))
    session.settings.integrator = LANCER_PATH;
  std::vector<lancer_texel> texels(session.pixels());
  for (lancer_texel &texel : texels) {
    texel.triangle = bytes.rarely(20) ? ~0u : bytes.below(kMostTriangle);
    for (float *pair : {texel.weights, texel.dx, texel.dy})
      for (int i = 0; i < 2; ++i)
        pair[i] = pair == texel.weights ? bytes.number(0.3f, 0.0f, 0.5f) : bytes.number(0.01f, -0.2f, 0.2f);
  }
  lancer_bake bake = {};
  bake.texels = bytes.rarely(2) ? nullptr : texels.data();
  bake.texel_count = bytes.rarely(4) ? bytes.word() : uint32_t(texels.size());
  bake.instance = bytes.reference(filled ? filled->instances : 0);
  bake.view = bytes.choice(3);
  bake.lacks = bytes.rarely(60) ? bytes.below(9) : 0;
  const bool nothing = bytes.rarely(2);
  if (LANCER_CHECKED(lancer_session_create_bake(scene, &camera, &session.settings, nothing ? nullptr : &bake,
                                                &session.handle)) != LANCER_OK)
    session.handle = 0;
  return session;
}

} // namespace lancer_fuzz
