// Meshes that commit() makes from described ones: displaced by materials, or laid in the plane of a flattening placement. The
// next scene takes them over where all that they depend on is the same.
#pragma once

#include "scene/description.h"

#include <memory>
#include <utility>
#include <vector>

namespace lancer {

struct DisplacedMesh {
  std::shared_ptr<const Mesh> from, made;
  uint32_t number = 0; // of the described mesh, in messages
  Instance instance;   // the first one with these materials
  std::vector<uint32_t> slots;
  std::vector<std::shared_ptr<const Material>> materials; // of slots
  ObjectInfo info;
  std::vector<std::pair<uint32_t, glm::vec4>> attributes; // of the object: name and value
  Messages messages;

  // Whether both are made from the same data; made and messages are ignored.
  bool same_source(const DisplacedMesh &other) const;
};

struct LaidMesh {
  std::shared_ptr<const Mesh> from, made;
  uint32_t number = 0;
  glm::dvec3 axis{0.0};
  bool keeps_generated = false;
  Messages messages;

  bool same_source(const LaidMesh &other) const {
    return from == other.from && number == other.number && axis == other.axis && keeps_generated == other.keeps_generated;
  }
};

struct MadeMeshes {
  std::vector<DisplacedMesh> displaced;
  std::vector<LaidMesh> laid;
};

// Returns the record that was made from the same data; null if there is none.
template <class Record> const Record *find_made(const std::vector<Record> *known, const Record &wanted) {
  if (known)
    for (const Record &record : *known)
      if (record.same_source(wanted))
        return &record;
  return nullptr;
}

} // namespace lancer
