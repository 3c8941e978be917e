// Checks shared by all readers of the user's records, numbers as text for their messages, and the reader of cameras.
#pragma once

#include "lancer.h"
#include "scene/camera.h"
#include "scene/error.h"

#include <cstdio>

namespace lancer {

inline std::string to_text(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", double(value));
  return text;
}

inline void check_rays(const std::string &object, uint32_t hidden_from) {
  if (hidden_from >= 2 * LANCER_RAY_VOLUME)
    bad_argument(object + ": hidden_from " + std::to_string(hidden_from) + " has bits beyond the last kind of ray");
}

// where: start of the message, "object: ".
inline void check_flags(const std::string &where, uint32_t flags, uint32_t known) {
  if (flags & ~known)
    bad_argument(where + "flags " + std::to_string(flags) + " has bits beyond the last flag");
}

// Checks and copies a camera; throws an Error for invalid values.
Camera read_camera(const lancer_camera &source);
// Throws an Error if the camera, in the normalised world, is too far from the scene.
void check_reach(const Camera &camera);

} // namespace lancer
