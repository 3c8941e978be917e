// What is refused before it takes the machine down: things that are larger than its memory.
#pragma once

#include "scene/error.h"

#include <cstdint>
#include <unistd.h>

namespace lancer {

// what: "image 'Sky': 65536 x 65536 texels".
inline void check_memory(const std::string &what, double bytes) {
  const double present = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  // Blender and the scene have their share, too.
  if (bytes > 0.8 * present)
    throw Error(Fault::Memory, what + " need " + std::to_string(uint64_t(bytes / 1e6)) + " MB, this machine has " +
                                   std::to_string(uint64_t(present / 1e6)) + " MB");
}

} // namespace lancer
