// Objects of scenes, and scenes that differ little, in the C interface.
#include "compile/prepare.h"
#include "lancer_probes.h"
#include "objects.h"
#include "render/thread_pool.h"

#include <string>
#include <utility>

namespace {

using namespace lancer;

// Checks the arguments and stores what read() returns.
template <class Record, class Read> lancer_status create(const Record *record, lancer_object *object, const Read &read) {
  return guard([&] {
    require(record, "object: record");
    require(object, "object");
    *object = parts().add(std::make_shared<const PartObject>(read(*record)));
    return LANCER_OK;
  });
}

// Returns the objects of these handles, which must be of one kind. place: names a handle in errors, before its number.
template <class T>
std::vector<Given<T>> parts_of(const char *place, const char *kind, uint32_t count, const lancer_object *handles) {
  if (count)
    require(handles, place);
  std::vector<Given<T>> objects;
  objects.reserve(count);
  for (uint32_t i = 0; i < count; ++i) {
    const auto part = part_of(handles[i]);
    const auto *given = std::get_if<Given<T>>(part.get());
    if (!given)
      bad_argument(std::string(place) + " " + std::to_string(i) + " is no " + kind);
    objects.push_back(*given);
  }
  return objects;
}

std::vector<Given<Image>> images_of(uint32_t count, const lancer_object *handles) {
  return parts_of<Image>("object: image", "image", count, handles);
}

// Returns an object of a record that may have messages. read: returns the object and fills the messages.
template <class T, class Read> Given<T> given_by(const Read &read) {
  Messages messages;
  T object = read(messages);
  return Given<T>(std::move(object), std::move(messages));
}

void set_objects(Description &description, uint32_t kind, uint32_t count, const lancer_object *objects) {
  constexpr const char *kPlace = "scene: object";
  switch (kind) {
  case LANCER_OBJECT_IMAGE:
    description.images = parts_of<Image>(kPlace, "image", count, objects);
    return;
  case LANCER_OBJECT_MESH:
    description.meshes = parts_of<Mesh>(kPlace, "mesh", count, objects);
    return;
  case LANCER_OBJECT_MATERIAL:
    description.materials = parts_of<Material>(kPlace, "material", count, objects);
    return;
  case LANCER_OBJECT_LIGHT:
    description.lights = parts_of<LightDescription>(kPlace, "light", count, objects);
    return;
  case LANCER_OBJECT_WORLD:
    if (count > 1)
      bad_argument("scene: " + std::to_string(count) + " worlds > 1");
    description.world = count ? parts_of<World>(kPlace, "world", count, objects).front() : Given<World>();
    return;
  default:
    bad_argument("scene: kind " + std::to_string(kind) + " of objects is not one of 0 ... 4");
  }
}

} // namespace

extern "C" {

lancer_status lancer_object_create_image(const lancer_image *image, uint32_t number, lancer_object *object) {
  return create(image, object, [&](const lancer_image &source) { return given_image(source, number); });
}

lancer_status lancer_object_create_mesh(const lancer_mesh *mesh, uint32_t number, lancer_object *object) {
  return create(mesh, object, [&](const lancer_mesh &source) {
    return given_by<Mesh>([&](Messages &messages) { return read_mesh(source, number, messages); });
  });
}

lancer_status lancer_object_create_material(const lancer_material *material, uint32_t number, uint32_t image_count,
                                            const lancer_object *images, lancer_object *object) {
  return create(material, object, [&](const lancer_material &source) {
    return given_by<Material>(
        [&](Messages &messages) { return read_material(source, number, images_of(image_count, images), messages); });
  });
}

lancer_status lancer_object_create_light(const lancer_light *light, uint32_t number, uint32_t image_count,
                                         const lancer_object *images, lancer_object *object) {
  return create(light, object, [&](const lancer_light &source) {
    return given_by<LightDescription>(
        [&](Messages &messages) { return read_light(source, number, images_of(image_count, images), messages); });
  });
}

lancer_status lancer_object_create_world(const lancer_world *world, uint32_t image_count, const lancer_object *images,
                                         lancer_object *object) {
  return create(world, object,
                [&](const lancer_world &source) { return Given<World>(read_world(source, images_of(image_count, images))); });
}

lancer_status lancer_object_destroy(lancer_object object) {
  return guard([&] {
    if (!parts().remove(object))
      throw BadHandle{"object: no such object, or it has been destroyed"};
    return LANCER_OK;
  });
}

lancer_status lancer_object_prepare(lancer_object object, uint32_t threads) {
  return guard([&] {
    check_threads("object", threads);
    const auto part = part_of(object);
    // The count reads files of the system, and a scene may have 100 000 meshes: it is made once.
    static const uint32_t processors = ThreadPool::resolved(0);
    if (const auto *mesh = std::get_if<Given<Mesh>>(part.get()))
      prepare(mesh->object, threads ? threads : processors);
    return LANCER_OK;
  });
}

lancer_status lancer_scene_edit(lancer_scene before, lancer_scene *scene) {
  return guard([&] {
    const auto known = scene_of(before);
    require(scene, "scene");
    const auto object = std::make_shared<SceneObject>();
    {
      const std::lock_guard lock(known->mutex);
      object->before = known->committed();
      object->description = known->description;
    }
    *scene = scenes().add(object);
    return LANCER_OK;
  });
}

lancer_status lancer_scene_set_objects(lancer_scene scene, uint32_t kind, uint32_t count, const lancer_object *objects) {
  return guard([&] {
    const auto object = scene_of(scene);
    const std::lock_guard lock(object->mutex);
    object->require_filling();
    set_objects(object->description, kind, count, objects);
    return LANCER_OK;
  });
}

lancer_status lancer_scene_clear_instances(lancer_scene scene) {
  return guard([&] {
    const auto object = scene_of(scene);
    const std::lock_guard lock(object->mutex);
    object->require_filling();
    Description &description = object->description;
    description.instances.clear();
    description.instances_given = 0;
    description.slots.clear();
    description.object_infos.clear();
    description.keys.clear();
    description.vectors.clear();
    description.object_attributes.clear();
    description.instance_messages = {};
    return LANCER_OK;
  });
}

lancer_status lancer_probe_made(lancer_scene scene, lancer_made *made) {
  return guard([&] {
    const auto object = scene_of(scene);
    require(made, "made");
    const std::lock_guard lock(object->mutex);
    object->committed();
    const MadeCounts &counts = object->made;
    *made = {counts.placements, counts.mesh_trees, counts.triangles, counts.changed_meshes,
             counts.materials,  counts.emitters,   counts.skies,     counts.plane_searches};
    return LANCER_OK;
  });
}

} // extern "C"
