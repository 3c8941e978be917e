// The scene before commit: checked copies of the user's records, in the user's units.
#pragma once

#include "lancer.h"
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

// Each function checks one record and copies it into the description. Throws Error, which names the object and the value; the
// description is then unchanged.
void add_mesh(Description &description, const lancer_mesh &mesh);
void add_instances(Description &description, uint32_t count, const lancer_instance *instances, uint32_t slot_count,
                   const uint32_t *slots, const char *names, size_t names_size);
void set_object_infos(Description &description, uint32_t count, const float *infos);
void add_object_attribute(Description &description, const char *name, uint32_t count, const float *values);
void add_material(Description &description, const lancer_material &material);
void add_light(Description &description, const lancer_light &light);
void add_image(Description &description, const lancer_image &image);
void set_world(Description &description, const lancer_world &world);

// Checks and copies the nodes of an owner ("material 'Wood'"); check_reference() checks a parameter that may refer to one of
// them.
Program read_program(Description &description, const std::string &owner, const lancer_node *nodes, uint32_t count);
void check_reference(const std::string &owner, const char *what, const lancer_parameter &parameter, const Program &program);

// Returns the index of a name in attribute_names; adds a new name.
uint32_t attribute_name(Description &description, const std::string &name);

// Returns "kind 'name'", or "kind #number" without a name.
std::string label(const char *kind, const char *name, size_t number);

} // namespace lancer
