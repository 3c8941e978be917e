#include "scene/names.h"

#include <mutex>
#include <unordered_map>
#include <vector>

namespace lancer {

namespace {

struct Names {
  std::mutex mutex;
  std::unordered_map<std::string, uint32_t> numbers{{"", 0}};
  std::vector<std::string> names{""};
};

// Never destroyed: a thread may still be inside a call while the process ends.
Names &all() {
  static auto *const names = new Names;
  return *names;
}

} // namespace

uint32_t attribute_name(const std::string &name) {
  Names &known = all();
  const std::lock_guard lock(known.mutex);
  const auto found = known.numbers.find(name);
  if (found != known.numbers.end())
    return found->second;
  known.names.push_back(name);
  return known.numbers[name] = uint32_t(known.names.size() - 1);
}

std::string attribute_of(uint32_t number) {
  Names &known = all();
  const std::lock_guard lock(known.mutex);
  return known.names[number];
}

} // namespace lancer
