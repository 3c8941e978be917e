// Checks that all readers of the user's records share, and numbers as text for their messages.
#pragma once

#include "lancer.h"
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

} // namespace lancer
