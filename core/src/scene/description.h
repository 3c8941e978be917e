// The description: checked copies of the user's records, in the user's units.
#pragma once

#include "scene/geometry.h"
#include "scene/image.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/messages.h"

#include <string>
#include <vector>

namespace lancer {

struct Description {
  Geometry geometry; // instances in the user's units, to_object not yet set
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

} // namespace lancer
