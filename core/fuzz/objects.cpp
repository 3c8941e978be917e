#include "objects.h"

#include "checked.h"

namespace lancer_fuzz {

Objects::~Objects() {
  for (const std::vector<lancer_object> &kind : objects_)
    for (const lancer_object object : kind)
      LANCER_CHECKED(lancer_object_destroy(object));
}

std::vector<lancer_object> Objects::some(uint32_t kind, uint32_t count) {
  std::vector<lancer_object> handles;
  for (uint32_t i = 0; i < count; ++i) {
    const std::vector<lancer_object> &known = objects_[bytes_.rarely(2) ? bytes_.below(kKinds) : kind];
    const uint32_t at = bytes_.byte();
    handles.push_back(at == 255 || known.empty() ? gone_ : known[at % known.size()]);
  }
  return handles;
}

void Objects::keep(uint32_t kind, lancer_status status, lancer_object object) {
  if (status != LANCER_OK)
    return;
  objects_[kind].push_back(object);
  LANCER_CHECKED(lancer_object_prepare(object, 1));
  // The oldest goes, whoever has it.
  if (objects_[kind].size() > kMost) {
    gone_ = objects_[kind].front();
    LANCER_CHECKED(lancer_object_destroy(gone_));
    objects_[kind].erase(objects_[kind].begin());
  }
}

void Objects::call() {
  const uint32_t kind = bytes_.below(kKinds);
  if (bytes_.rarely(20)) {
    const std::vector<lancer_object> handle = some(kind, 1);
    if (LANCER_CHECKED(lancer_object_destroy(handle[0])) == LANCER_OK) {
      gone_ = handle[0];
      for (std::vector<lancer_object> &known : objects_)
        std::erase(known, gone_);
    }
    return;
  }
  lancer_object object = 0;
  lancer_object *const out = bytes_.rarely(1) ? nullptr : &object;
  const uint32_t number = bytes_.below(4);
  if (kind == LANCER_OBJECT_MESH) {
    const lancer_mesh mesh = records_.mesh();
    return keep(kind, LANCER_CHECKED(lancer_object_create_mesh(&mesh, number, out)), object);
  }
  if (kind == LANCER_OBJECT_IMAGE) {
    const lancer_image image = records_.image();
    return keep(kind, LANCER_CHECKED(lancer_object_create_image(&image, number, out)), object);
  }
  Filled filled;
  filled.images = bytes_.below(3);
  const std::vector<lancer_object> images = some(LANCER_OBJECT_IMAGE, filled.images);
  if (kind == LANCER_OBJECT_MATERIAL) {
    const lancer_material material = records_.material(filled);
    return keep(kind, LANCER_CHECKED(lancer_object_create_material(&material, number, filled.images, images.data(), out)),
                object);
  }
  if (kind == LANCER_OBJECT_LIGHT) {
    const lancer_light light = records_.light(filled);
    return keep(kind, LANCER_CHECKED(lancer_object_create_light(&light, number, filled.images, images.data(), out)), object);
  }
  const lancer_world world = records_.world(filled);
  keep(kind, LANCER_CHECKED(lancer_object_create_world(&world, filled.images, images.data(), out)), object);
}

void Objects::edit(lancer_scene before, size_t most) {
  if (scenes_.size() >= most)
    return;
  const SceneState *known = state_of(scenes_, before);
  SceneState scene;
  if (known)
    scene.filled = known->filled;
  if (LANCER_CHECKED(lancer_scene_edit(before, &scene.handle)) != LANCER_OK)
    return;
  scenes_.push_back(scene);
  change(scene.handle);
}

void Objects::change(lancer_scene scene) {
  SceneState *const state = state_of(scenes_, scene);
  if (bytes_.rarely(40)) {
    if (LANCER_CHECKED(lancer_scene_clear_instances(scene)) == LANCER_OK)
      state->filled.instances = 0;
    return;
  }
  const uint32_t kind = bytes_.rarely(1) ? 9 : bytes_.below(kKinds), count = bytes_.below(4);
  const std::vector<lancer_object> handles = some(kind % kKinds, count);
  if (LANCER_CHECKED(lancer_scene_set_objects(scene, kind, count, handles.data())) != LANCER_OK)
    return;
  uint32_t none = 0;
  uint32_t &filled = kind == LANCER_OBJECT_MESH       ? state->filled.meshes
                     : kind == LANCER_OBJECT_IMAGE    ? state->filled.images
                     : kind == LANCER_OBJECT_MATERIAL ? state->filled.materials
                     : kind == LANCER_OBJECT_LIGHT    ? state->filled.lights
                                                      : none;
  filled = count;
}

} // namespace lancer_fuzz
