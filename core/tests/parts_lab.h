// Sessions of parts of a small picture, for the tests of parts.
#pragma once

#include "tiny_scene.h"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace lancer_test {

using Bytes = std::vector<uint8_t>;

inline constexpr uint8_t kDigest[32] = {1, 2, 3};
inline constexpr uint32_t kWidth = 40, kHeight = 23;

inline lancer_settings settings_of_parts(uint32_t integrator = LANCER_PATH) {
  lancer_settings settings = make_settings(integrator);
  settings.refines = 1;
  settings.samples = 64;
  settings.split_lights = 2;
  settings.split_paths = 1;
  settings.clamp_indirect = 0.5f;
  return settings;
}

inline lancer_scene named_scene() {
  const lancer_scene scene = make_scene();
  EXPECT_EQ(lancer_scene_set_digest(scene, kDigest), LANCER_OK);
  return scene;
}

// A session of a scene, or one that joins parts.
struct Owned {
  lancer_session handle = 0;

  Owned(lancer_scene scene, const lancer_settings &settings, const lancer_camera &camera = make_camera(kWidth, kHeight)) {
    EXPECT_EQ(scene ? lancer_session_create(scene, &camera, &settings, &handle)
                    : lancer_session_create_joiner(kDigest, &camera, &settings, &handle),
              LANCER_OK)
        << lancer_last_error();
  }
  Owned(const Owned &) = delete;
  ~Owned() { lancer_session_destroy(handle); }
};

inline Bytes exported(lancer_session session) {
  size_t needed = 0;
  EXPECT_EQ(lancer_session_export(session, nullptr, 0, &needed), LANCER_OK) << lancer_last_error();
  Bytes bytes(needed);
  EXPECT_EQ(lancer_session_export(session, bytes.data(), bytes.size(), nullptr), LANCER_OK);
  return bytes;
}

inline lancer_status import(lancer_session session, const Bytes &part) {
  return lancer_session_import(session, part.data(), part.size());
}

inline uint32_t tile_count(lancer_session session) {
  uint32_t count = 0;
  EXPECT_EQ(lancer_session_tiles(session, 0, nullptr, &count), LANCER_OK);
  return count;
}

inline Bytes rendered(lancer_session session, const std::vector<lancer_range> &ranges) {
  EXPECT_EQ(lancer_session_clear(session), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(lancer_session_render_ranges(session, uint32_t(ranges.size()), ranges.data()), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(finish(session), LANCER_OK) << lancer_last_error();
  return exported(session);
}

inline std::vector<float> read(lancer_session session, uint32_t pass) {
  std::vector<float> picture;
  for (const size_t channels : {1, 3, 4}) {
    picture.assign(kWidth * kHeight * channels, 0.0f);
    if (lancer_session_read(session, pass, picture.data(), picture.size()) == LANCER_OK)
      break;
  }
  return picture;
}

inline void expect_equal_pictures(lancer_session one, lancer_session other) {
  for (uint32_t pass = 0; pass < LANCER_PASS_COUNT; ++pass)
    EXPECT_EQ(read(one, pass), read(other, pass)) << pass;
  lancer_error errors[2];
  lancer_session_error(one, 0.95, &errors[0]);
  lancer_session_error(other, 0.95, &errors[1]);
  for (double lancer_error::*value : {&lancer_error::error, &lancer_error::low, &lancer_error::high,
                                      &lancer_error::cannot_exclude, &lancer_error::clipped, &lancer_error::missing})
    EXPECT_EQ(errors[0].*value, errors[1].*value);
}

inline void expect_equal(lancer_session one, lancer_session other) {
  expect_equal_pictures(one, other);
  EXPECT_EQ(exported(one), exported(other));
}

} // namespace lancer_test
