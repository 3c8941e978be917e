// What nodes know of the object that a ray has met: where it is, and what tells it from others of its kind.
#include "scene/node_site.h"
#include "scene/scene.h"

namespace lancer {

glm::vec4 object_info(const Node &node, const Site &site) {
  const Instance *instance = site.instance();
  if (!instance)
    return glm::vec4(0.0f);
  const std::vector<ObjectInfo> &all = site.context->geometry->object_infos;
  const ObjectInfo info = instance->number < all.size() ? all[instance->number] : ObjectInfo();
  switch (node.option) {
  case LANCER_OBJECT_LOCATION: {
    const glm::dvec3 &origin = instance->to_world.translation;
    return solid(glm::vec3(site.context->normalisation ? site.context->normalisation->to_world(origin) : origin));
  }
  case LANCER_OBJECT_COLOR:
    return info.color;
  case LANCER_OBJECT_INDEX:
    return scalar(float(instance->object_index));
  default:
    return scalar(info.random);
  }
}

} // namespace lancer
