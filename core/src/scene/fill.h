// Checks that all readers of the user's records share, numbers as text for their messages, and the camera's reader.
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

// where: what the sentence begins with, "object: ".
inline void check_flags(const std::string &where, uint32_t flags, uint32_t known) {
  if (flags & ~known)
    bad_argument(where + "flags " + std::to_string(flags) + " has bits beyond the last flag");
}

// Checks and copies a camera; an Error says what no camera can have.
Camera read_camera(const lancer_camera &source);
// An Error where the camera, in the normalised world, is too far from everything.
void check_reach(const Camera &camera);

} // namespace lancer
