// Open Image Denoise with the interface of version 1, for tests: only the functions of version 1, with their parameters of
// version 1, implemented by the library of version 2 that the environment variable LANCER_TEST_OIDN names. Blender 3.x
// contains version 1.

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>

namespace {

void *theirs(const char *name) {
  // Not linked, so that a search for a function in this library does not continue in the other.
  static void *const library = dlopen(std::getenv("LANCER_TEST_OIDN"), RTLD_NOW | RTLD_LOCAL);
  return dlsym(library, name);
}

} // namespace

#define FORWARD(result, name, newer, parameters, ...)                                                                          \
  extern "C" result name parameters { return reinterpret_cast<result(*) parameters>(theirs(newer))(__VA_ARGS__); }

using Monitor = bool (*)(void *, double);

FORWARD(void *, oidnNewDevice, "oidnNewDevice", (int type), type)
FORWARD(void, oidnCommitDevice, "oidnCommitDevice", (void *device), device)
FORWARD(void, oidnReleaseDevice, "oidnReleaseDevice", (void *device), device)
FORWARD(int, oidnGetDeviceError, "oidnGetDeviceError", (void *device, const char **text), device, text)
FORWARD(void, oidnSetDevice1b, "oidnSetDeviceBool", (void *device, const char *name, bool value), device, name, value)
FORWARD(void, oidnSetDevice1i, "oidnSetDeviceInt", (void *device, const char *name, int value), device, name, value)
FORWARD(void *, oidnNewFilter, "oidnNewFilter", (void *device, const char *type), device, type)
FORWARD(void, oidnReleaseFilter, "oidnReleaseFilter", (void *filter), filter)
FORWARD(void, oidnSetSharedFilterImage, "oidnSetSharedFilterImage",
        (void *filter, const char *name, void *memory, int format, std::size_t width, std::size_t height, std::size_t offset,
         std::size_t pixel, std::size_t row),
        filter, name, memory, format, width, height, offset, pixel, row)
FORWARD(void, oidnSetFilter1b, "oidnSetFilterBool", (void *filter, const char *name, bool value), filter, name, value)
FORWARD(void, oidnSetFilter1i, "oidnSetFilterInt", (void *filter, const char *name, int value), filter, name, value)
FORWARD(void, oidnSetFilterProgressMonitorFunction, "oidnSetFilterProgressMonitorFunction",
        (void *filter, Monitor monitor, void *user), filter, monitor, user)
FORWARD(void, oidnCommitFilter, "oidnCommitFilter", (void *filter), filter)
FORWARD(void, oidnExecuteFilter, "oidnExecuteFilter", (void *filter), filter)

extern "C" int oidnGetDevice1i(void *device, const char *name) {
  if (std::strcmp(name, "version") == 0)
    return 10403;
  return reinterpret_cast<int (*)(void *, const char *)>(theirs("oidnGetDeviceInt"))(device, name);
}
