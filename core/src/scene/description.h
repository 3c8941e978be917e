// The scene before commit: checked copies of the user's records, in the user's units.
#pragma once

#include "scene/geometry.h"
#include "scene/image.h"
#include "scene/light.h"
#include "scene/material.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace lancer {

// Reports of data that were left out or replaced, one line each; equal lines are merged with a count.
class Messages {
public:
  void add(const std::string &object, const std::string &what);
  void add(const Messages &others);
  // Returns all lines, each with a trailing newline.
  std::string text() const;

private:
  struct Line {
    std::string text;
    uint64_t count;
  };
  void add_line(const std::string &text, uint64_t count);

  std::vector<Line> lines_;
  std::unordered_map<std::string, size_t> numbers_; // index of a line by its text
};

struct Description {
  Geometry geometry; // instances in world units, to_object not yet set
  std::vector<uint32_t> slots;
  std::vector<Material> materials;
  std::vector<LightDescription> lights;
  std::vector<Image> images;
  std::vector<std::string> attribute_names{""}; // read by nodes; Node::name is an index into this list
  World world;
  uint32_t instances_given = 0; // including those left out
  Messages messages;
};

// Returns the index of a name in attribute_names; adds a new name.
uint32_t attribute_name(Description &description, const std::string &name);

// Returns "kind 'name'", or "kind #number" without a name.
std::string label(const char *kind, const char *name, size_t number);

} // namespace lancer
