#include "scene/error.h"

#include <cstdint>

#if defined(_WIN32)
#define NOMINMAX
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <unistd.h>
#endif

namespace lancer {

double physical_memory() {
#if defined(_WIN32)
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof status;
  GlobalMemoryStatusEx(&status);
  return double(status.ullTotalPhys);
#else
  return double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
#endif
}

void check_memory(const std::string &what, double bytes) {
  const double present = physical_memory();
  // Leave a share to Blender and the scene.
  if (bytes > 0.8 * present)
    throw Error(Fault::Memory, what + " need " + std::to_string(uint64_t(bytes / 1e6)) + " MB, this machine has " +
                                   std::to_string(uint64_t(present / 1e6)) + " MB");
}

} // namespace lancer
