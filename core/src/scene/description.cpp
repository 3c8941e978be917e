#include "scene/description.h"

namespace lancer {

std::string Description::messages() const {
  Messages all;
  const auto add = [&](const auto &objects) {
    for (const auto &given : objects)
      all.add(*given.messages);
  };
  add(images);
  add(meshes);
  add(materials);
  add(lights);
  all.add(instance_messages);
  all.add(made_messages);
  return all.text();
}

} // namespace lancer
