#include "scene/messages.h"

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

void Messages::add(const std::string &object, const std::string &what) { add_line(object + ": " + what, 1); }

void Messages::add(const Messages &others) {
  for (const Line &line : others.lines_)
    add_line(line.text, line.count);
}

void Messages::add_line(const std::string &text, uint64_t count) {
  const auto [known, fresh] = numbers_.emplace(text, lines_.size());
  if (fresh)
    lines_.push_back({text, count});
  else
    lines_[known->second].count += count;
}

std::string Messages::text() const {
  std::string all;
  for (const Line &line : lines_)
    all += line.text + (line.count > 1 ? " (" + std::to_string(line.count) + " times)" : "") + "\n";
  return all;
}

std::string label(const char *kind, const char *name, size_t number) {
  if (name && *name)
    return std::string(kind) + " '" + name + "'";
  return std::string(kind) + " #" + std::to_string(number);
}

} // namespace lancer
