#include "scene/description.h"

#include "scene/error.h"

#include <cmath>

namespace lancer {

void Messages::add(const std::string &object, const std::string &what) {
  const std::string text = object + ": " + what;
  const auto [known, fresh] = numbers_.emplace(text, lines_.size());
  if (fresh)
    lines_.push_back({text, 1});
  else
    ++lines_[known->second].count;
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

void set_world(Description &description, const float radiance[3]) {
  if (!radiance)
    bad_argument("world: radiance is NULL");
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(radiance[i]) || radiance[i] < 0.0f)
      bad_argument("world: radiance " + std::to_string(radiance[i]) + " must be finite and not negative");
    description.world[i] = radiance[i];
  }
}

} // namespace lancer
