#include "scene/description.h"

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

} // namespace lancer
