// From a description to a scene: find features, displace, flatten, normalise, make lobes and cutouts ready, make lights, build
// the accelerator.
#include "accel/coplanar/coplanar_faces.h"
#include "compile/features.h"
#include "compile/scene.h"
#include "compile/steps.h"
#include "simd/parallel.h"

#include <chrono>
#include <map>

namespace lancer {

namespace {

// Returns one number per instance: 1 if the predicate holds for one of its materials.
template <class Predicate> std::vector<uint8_t> find_instances(const Scene &scene, Predicate &&predicate) {
  std::vector<uint8_t> found;
  for (const Instance &instance : scene.geometry.instances) {
    bool any = false;
    for (uint32_t slot = 0; slot < instance.slot_count; ++slot)
      any = any || predicate(instance, scene.slots[instance.first_slot + slot]);
    found.push_back(any);
  }
  return found;
}

PlaneRules plane_rules(const Scene &scene) {
  PlaneRules rules;
  rules.origin = scene.normalisation.to_normalised(glm::dvec3(0.0));
  for (const uint32_t material : scene.slots) {
    rules.see_through_slots.push_back(lets_light_through(scene.materials[material]));
    rules.emitting_slots.push_back(scene.materials[material].emits());
  }
  return rules;
}

Motion normalised(Motion motion, const Normalisation &normalisation) {
  for (Camera &camera : motion.cameras)
    camera.scale_lengths(normalisation.scale);
  for (PlacementKey &place : motion.places)
    place.translation = normalisation.to_normalised(place.translation);
  return motion;
}

InstanceVectors place_vectors(std::span<const GivenVectors> given, const Scene &scene) {
  InstanceVectors vectors;
  if (given.empty())
    return vectors;
  const std::span<const Instance> instances = scene.geometry.instances;
  std::map<uint32_t, uint32_t> place_of; // by Instance::number
  for (uint32_t i = 0; i < instances.size(); ++i)
    place_of[instances[i].number] = i;
  vectors.of_instance.assign(instances.size(), kNone);
  for (const GivenVectors &of : given) {
    // An instance that was left out shows nothing.
    const auto place = place_of.find(of.instance);
    if (place == place_of.end())
      continue;
    vectors.of_instance[place->second] = uint32_t(vectors.places.size());
    MomentPlaces &places = vectors.places.emplace_back();
    for (uint32_t moment = 0; moment < kMoments; ++moment)
      places[moment] = scene.normalisation.to_normalised(of.to_world[moment]);
  }
  return vectors;
}

Environment make_environment(const Scene &scene, const BuildContext &context, const Scene *before) {
  constexpr uint32_t kAsked = kFeatureGlass | kFeatureOpenings;
  if (before && before->world_owner == scene.world_owner && (before->features & kAsked) == (scene.features & kAsked))
    return Environment(before->lights.environment(), scene.normalisation);
  return Environment(scene.world, scene.normalisation, context, scene.features & kFeatureGlass,
                     scene.features & kFeatureOpenings);
}

// Returns the bits of the sets of receivers that there are.
uint64_t receiver_sets(const GeometryView &geometry) {
  uint64_t sets = 0;
  for (const Instance &instance : geometry.instances)
    sets |= uint64_t{1} << instance.receiver_set;
  return sets;
}

LightSet make_lights(Scene &scene, const BuildContext &context, const Scene *before) {
  EmissionAt emission(scene.node_scene(nullptr), scene.materials);
  std::vector<Light> lights, openings;
  for (const auto &light : scene.light_owners) {
    if (light->opening) {
      if (const Light opening = place_light(*light, scene.normalisation); opening.area > 0.0)
        openings.push_back(opening);
      continue;
    }
    lights.push_back(place_light(*light, scene.normalisation));
    add_lamp_shader(*light, lights.back(), scene.normalisation, scene.lamp_shaders);
  }
  if (!scene.lamp_shaders.empty())
    parallel_for(context, lights.size(), [&](size_t i) {
      if (lights[i].shader != kNone)
        lights[i].level = mean_strength(lights[i], scene.lamp_shaders, scene.node_scene(nullptr));
    });
  const EmitterSources sources{scene.placed->owners, scene.material_owners, before ? &before->made_emitters : nullptr,
                               &scene.made_emitters};
  return LightSet(std::move(lights), make_emitters(scene.geometry, scene.slots, scene.materials, emission, context, sources),
                  scene.geometry.instances.size(), make_environment(scene, context, before), context,
                  receiver_sets(scene.geometry), std::move(openings));
}

// Marks the blockers that the light of some lamp or emitter passes, beside the instances that let light pass straight through.
void find_linked_blockers(Scene &scene) {
  if (!scene.lights.passes_blockers())
    return;
  uint64_t clear = 0;
  for (uint32_t light = 0; light < scene.lights.size(); ++light)
    clear |= scene.lights.links(light).clear_sets;
  scene.linked_blockers = scene.transparent_instances;
  for (size_t i = 0; i < scene.geometry.instances.size(); ++i)
    if (clear >> scene.geometry.instances[i].blocker_set & 1)
      scene.linked_blockers[i] = 1;
}

void make_materials_ready(Scene &scene, Description &description, const BuildContext &context) {
  for (size_t i = 0; i < description.materials.size(); ++i) {
    const Material &material = *description.materials[i];
    const auto ready = material.ready.get([&] {
      count_made(context, &MadeCounts::materials);
      return ReadyMaterial{make_ready_lobes(material), make_cutout(material)};
    });
    scene.material_owners.push_back(description.materials[i].object);
    scene.ready_materials.push_back(ready);
    scene.materials.emplace_back(material).ready = ready->lobes.lobes.data();
    scene.cutouts.push_back(ready->cutout);
    report_limits(label("material", material.name.c_str(), i), material, description.made_messages);
  }
  scene.classes = shading_classes(scene.materials);
}

} // namespace

namespace {

// Hides all objects but shadow catchers from rays among these.
void hide_from_catchers(std::span<Instance> instances) {
  for (Instance &instance : instances)
    instance.hidden_from = instance.catcher ? hidden_of_catcher(instance.hidden_from) : hidden_of_other(instance.hidden_from);
}

} // namespace

std::shared_ptr<const Scene> commit(const Description &given, AcceleratorKind kind, const BuildContext &context,
                                    const Scene *before) {
  const auto start = std::chrono::steady_clock::now();
  auto scene = std::make_shared<Scene>();
  Description description = given;
  const Features features = find_features(description);
  scene->features = features.bits;
  scene->shapes = features.shapes;
  if (features.bits & kFeatureCatchers)
    hide_from_catchers(description.instances);
  // Displace vertices before computing bounds and lights from them.
  const MadeMeshes *const made_before = before ? &before->made_meshes : nullptr;
  if (features.bits & kFeatureDisplacement)
    displace(description, context, scene->made_meshes, made_before);
  flatten(description, context, scene->made_meshes, made_before);
  make_materials_ready(*scene, description, context);
  for (const Given<Image> &image : description.images)
    scene->images.push_back(image.object);
  for (const Given<LightDescription> &light : description.lights)
    scene->light_owners.push_back(light.object);
  scene->world_owner = description.world.object;
  scene->world = *scene->world_owner;
  // Place everything in the normalised world.
  scene->placed = place_geometry(description, kind, context, before ? before->placed : nullptr);
  scene->geometry = scene->placed->view;
  scene->normalisation = scene->placed->normalisation;
  if (description.motion)
    scene->motion = normalised(*description.motion, scene->normalisation);
  scene->vectors = place_vectors(description.vectors, *scene);
  scene->slots = std::move(description.slots);
  scene->transparent_instances =
      find_instances(*scene, [&](const Instance &, uint32_t material) { return scene->materials[material].is_transparent(); });
  scene->perforated_instances = find_instances(*scene, [&](const Instance &instance, uint32_t material) {
    return instance.kind == ShapeKind::Mesh && !instance.holdout && scene->cutouts[material].may_end;
  });
  scene->lights = make_lights(*scene, context, before);
  find_linked_blockers(*scene);
  scene->plane_rules = plane_rules(*scene);
  const bool same_planes = before && before->placed == scene->placed && before->plane_rules == scene->plane_rules;
  scene->accelerator = same_planes ? before->accelerator
                                   : order_coplanar_faces(scene->placed->accelerator, scene->geometry, scene->plane_rules,
                                                          context, scene->placed->owner_of);
  if (!same_planes)
    count_made(context, &MadeCounts::plane_searches);
  scene->messages = description.messages();
  scene->build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return scene;
}

uint32_t Scene::face_number(uint32_t instance, uint32_t primitive) const {
  const Instance &placed_one = geometry.instances[instance];
  const bool renumbered = placed_one.kind == ShapeKind::Mesh && !geometry.meshes[placed_one.mesh].face_of.empty();
  return renumbered ? geometry.meshes[placed_one.mesh].face_of[primitive] : primitive;
}

size_t Scene::geometry_bytes() const {
  return placed->bytes() + vectors.bytes() + slots.size() * sizeof(uint32_t) + transparent_instances.size() +
         perforated_instances.size() + linked_blockers.size() + lights.bytes();
}

size_t Scene::texture_bytes() const {
  size_t bytes = 0;
  for (const auto &image : images)
    bytes += image->in_blocks ? 0 : image->bytes();
  return bytes;
}

size_t Scene::mapped_bytes() const {
  size_t bytes = 0;
  for (const auto &image : images)
    bytes += image->in_blocks ? image->bytes() : 0;
  return bytes;
}

} // namespace lancer
