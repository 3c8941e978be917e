#include "scene/description.h"

namespace lancer {

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
