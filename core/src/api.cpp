// Scenes in the C interface: checks handles and pointers, turns exceptions into statuses, and calls the rooms.
#include "lancer_probes.h"
#include "nodes/mipmaps.h"
#include "objects.h"
#include "render/denoised.h"
#include "render/session.h"
#include "scene/fill.h"
#include "simd/processor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace {

using namespace lancer;

// Calls fill with the description of a scene that is not committed yet.
template <class Fill> lancer_status fill_scene(lancer_scene handle, const void *record, const char *name, Fill &&fill) {
  return guard([&] {
    const auto object = scene_of(handle);
    require(record, name);
    const std::lock_guard lock(object->mutex);
    object->require_filling();
    fill(object->description);
    return LANCER_OK;
  });
}

} // namespace

extern "C" {

uint32_t lancer_abi_version(void) { return LANCER_ABI_VERSION; }
const char *lancer_version(void) { return LANCER_VERSION; }
const char *lancer_last_error(void) { return last_error; }

uint32_t lancer_sizeof(uint32_t which) {
  static constexpr size_t sizes[LANCER_STRUCT_COUNT] = {
      sizeof(lancer_mesh),           sizeof(lancer_instance),    sizeof(lancer_parameter),
      sizeof(lancer_lobe),           sizeof(lancer_material),    sizeof(lancer_light),
      sizeof(lancer_camera),         sizeof(lancer_settings),    sizeof(lancer_progress),
      sizeof(lancer_statistics),     sizeof(lancer_hit),         sizeof(lancer_vertex),
      sizeof(lancer_light_sample),   sizeof(lancer_bsdf_sample), sizeof(lancer_attribute),
      sizeof(lancer_image),          sizeof(lancer_node),        sizeof(lancer_principled),
      sizeof(lancer_world),          sizeof(lancer_lobe_info),   sizeof(lancer_error),
      sizeof(lancer_denoised_error), sizeof(lancer_range),       sizeof(lancer_part),
      sizeof(lancer_portal),         sizeof(lancer_made),        sizeof(lancer_motion),
      sizeof(lancer_output),         sizeof(lancer_texel),       sizeof(lancer_bake)};
  return which < LANCER_STRUCT_COUNT ? uint32_t(sizes[which]) : 0;
}

lancer_status lancer_scene_create(lancer_scene *scene) {
  return guard([&] {
    require(scene, "scene");
    *scene = scenes().add(std::make_shared<SceneObject>());
    return LANCER_OK;
  });
}

lancer_status lancer_scene_destroy(lancer_scene scene) {
  return guard([&] {
    const auto object = scenes().remove(scene);
    if (!object)
      throw BadHandle{"scene: no such scene, or it has been destroyed"};
    object->cancel = true;
    return LANCER_OK;
  });
}

lancer_status lancer_scene_add_mesh(lancer_scene scene, const lancer_mesh *mesh) {
  return fill_scene(scene, mesh, "mesh", [&](Description &description) { add_mesh(description, *mesh); });
}

lancer_status lancer_scene_add_material(lancer_scene scene, const lancer_material *material) {
  return fill_scene(scene, material, "material", [&](Description &description) { add_material(description, *material); });
}

lancer_status lancer_scene_add_light(lancer_scene scene, const lancer_light *light) {
  return fill_scene(scene, light, "light", [&](Description &description) { add_light(description, *light); });
}

lancer_status lancer_scene_add_instances(lancer_scene scene, uint32_t count, const lancer_instance *instances,
                                         uint32_t slot_count, const uint32_t *slots, const char *names, size_t names_size) {
  // Without instances, the array may be null.
  static const char nothing = 0;
  return fill_scene(scene, &nothing, "instances", [&](Description &description) {
    add_instances(description, count, instances, slot_count, slots, names, names_size);
  });
}

lancer_status lancer_scene_set_object_infos(lancer_scene scene, uint32_t count, const float *infos) {
  return fill_scene(scene, infos, "object infos",
                    [&](Description &description) { set_object_infos(description, count, infos); });
}

lancer_status lancer_scene_move_instances(lancer_scene scene, uint32_t count, const uint32_t *instances, uint32_t key_count,
                                          const double *matrices) {
  static const char nothing = 0;
  return fill_scene(scene, &nothing, "motion",
                    [&](Description &description) { move_instances(description, count, instances, key_count, matrices); });
}

lancer_status lancer_scene_set_vectors(lancer_scene scene, uint32_t count, const uint32_t *instances, const double *matrices) {
  static const char nothing = 0;
  return fill_scene(scene, &nothing, "vectors",
                    [&](Description &description) { set_vectors(description, count, instances, matrices); });
}

lancer_status lancer_scene_set_motion(lancer_scene scene, const lancer_motion *motion) {
  return fill_scene(scene, motion, "motion", [&](Description &description) { set_motion(description, *motion); });
}

lancer_status lancer_scene_add_object_attribute(lancer_scene scene, const char *name, uint32_t count, const float *values) {
  return fill_scene(scene, values, "object attribute",
                    [&](Description &description) { add_object_attribute(description, name, count, values); });
}

lancer_status lancer_scene_add_image(lancer_scene scene, const lancer_image *image) {
  return fill_scene(scene, image, "image", [&](Description &description) {
    description.images.push_back(given_image(*image, description.images.size()));
  });
}

lancer_status lancer_make_mipmaps(const lancer_image *image, void *levels) {
  return guard([&] {
    require(image, "image");
    require(levels, "levels");
    lancer_image source = *image;
    source.mipmaps = 1;
    Messages messages;
    Image made = read_image(source, 0, messages);
    if (made.in_blocks)
      bad_argument("image: levels are made of rows, not of blocks");
    make_mipmaps(made);
    std::memcpy(levels, made.texels + made.level_offset(1), made.bytes() - made.level_offset(1));
    return LANCER_OK;
  });
}

lancer_status lancer_scene_set_world(lancer_scene scene, const lancer_world *world) {
  return fill_scene(scene, world, "world", [&](Description &description) { set_world(description, *world); });
}

lancer_status lancer_scene_commit(lancer_scene scene, uint32_t accelerator, uint32_t threads) {
  return guard([&] {
    const auto object = scene_of(scene);
    const std::lock_guard lock(object->mutex);
    object->require_filling();
    if (accelerator > LANCER_BRUTE_FORCE)
      bad_argument("scene: accelerator " + std::to_string(accelerator) + " is not one of 0, 1, 2");
    check_threads("scene", threads);
    object->messages = object->description.messages();
    BuildContext context;
    context.threads = ThreadPool::resolved(threads);
    context.cancel = &object->cancel;
    context.made = &object->made;
    check_references(object->description);
    object->builder = std::make_unique<ThreadPool>(1);
    object->cancel = false;
    // The object owns the thread, so the pointer is valid for as long as the thread works.
    SceneObject *const target = object.get();
    object->builder->start([target, accelerator, context](uint32_t) {
      target->scene = commit(target->description, static_cast<AcceleratorKind>(accelerator), context, target->before.get());
      target->before.reset();
    });
    // Change the state only after the thread has started: if memory is missing, no commit is running.
    object->state = SceneObject::State::Committing;
    return LANCER_OK;
  });
}

lancer_status lancer_scene_wait(lancer_scene scene, uint32_t milliseconds) {
  return guard([&]() -> lancer_status {
    const auto object = scene_of(scene);
    const std::lock_guard lock(object->mutex);
    if (object->state != SceneObject::State::Committing) {
      object->committed();
      return LANCER_OK;
    }
    try {
      if (!object->builder->wait(milliseconds))
        return LANCER_RUNNING;
    } catch (const BuildCancelled &) {
      object->state = SceneObject::State::Failed;
      return LANCER_CANCELLED;
    } catch (...) {
      object->state = SceneObject::State::Failed;
      throw;
    }
    // The copy takes memory: if it fails, the caller can wait for the scene again.
    object->messages = object->scene->messages;
    object->builder.reset();
    object->state = SceneObject::State::Committed;
    return LANCER_OK;
  });
}

lancer_status lancer_scene_cancel(lancer_scene scene) {
  return guard([&] {
    scene_of(scene)->cancel = true;
    return LANCER_OK;
  });
}

lancer_status lancer_scene_messages(lancer_scene scene, char *text, size_t size, size_t *needed) {
  return guard([&] {
    const auto object = scene_of(scene);
    const std::lock_guard lock(object->mutex);
    if (object->state == SceneObject::State::Committing)
      throw Error(Fault::State, "scene: wait for its commit first");
    const std::string messages =
        object->state == SceneObject::State::Filling ? object->description.messages() : object->messages;
    if (needed)
      *needed = messages.size() + 1;
    if (size) {
      require(text, "messages: text");
      copy_text(text, size, messages);
    }
    return LANCER_OK;
  });
}

} // extern "C"
