// The description: checked copies of the user's records, in the user's units. Scenes that differ little share them.
#pragma once

#include "scene/geometry.h"
#include "scene/image.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/messages.h"
#include "scene/shutter.h"
#include "scene/vectors.h"

#include <memory>
#include <string>
#include <vector>

namespace lancer {

// An immutable object of any number of scenes, and the messages about it, which every scene that has the object tells.
template <class T> struct Given {
  std::shared_ptr<const T> object;
  std::shared_ptr<const Messages> messages;

  Given() : Given(T{}) {}
  explicit Given(T read, Messages told = {})
      : object(std::make_shared<const T>(std::move(read))), messages(std::make_shared<const Messages>(std::move(told))) {}
  const T &operator*() const { return *object; }
  const T *operator->() const { return object.get(); }
};

struct Description {
  std::vector<Given<Mesh>> meshes;
  std::vector<Instance> instances; // to_object not yet set
  std::vector<ObjectInfo> object_infos;
  std::vector<ObjectAttribute> object_attributes;
  std::vector<uint32_t> slots;
  std::vector<Given<Material>> materials;
  std::vector<Given<LightDescription>> lights;
  std::vector<Given<Image>> images;
  Given<World> world;
  uint32_t instances_given = 0;         // including those left out
  std::vector<PlacementKey> keys;       // of instances that move
  std::vector<GivenVectors> vectors;    // of instances that move between moments
  std::shared_ptr<const Motion> motion; // of the camera and the shutter; null: everything is seen at the middle time
  Messages instance_messages;
  Messages made_messages; // about the parts that commit() makes

  // Returns all messages, in the order of the kinds of objects.
  std::string messages() const;
};

} // namespace lancer
