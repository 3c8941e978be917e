// From a description to a scene: find features, displace, flatten, normalise, make lobes and cutouts ready, make lights, build
// the accelerator.
#include "accel/coplanar/coplanar_faces.h"
#include "compile/features.h"
#include "compile/scene.h"
#include "compile/steps.h"
#include "simd/parallel.h"

#include <chrono>
#include <cmath>

namespace lancer {

namespace {

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3 &p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  bool empty() const { return !(low.x <= high.x); }
};

void add_box(Box &world, const Affine &map, const glm::dvec3 &low, const glm::dvec3 &high) {
  for (int corner = 0; corner < 8; ++corner)
    world.add(map.point({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z}));
}

Box world_bounds(const Description &description, const BuildContext &context) {
  const Geometry &geometry = description.geometry;
  std::vector<Box> meshes(geometry.meshes.size());
  for (size_t i = 0; i < meshes.size(); ++i) {
    poll_cancel(context);
    for (const glm::uvec3 &triangle : geometry.meshes[i].triangles)
      for (int corner = 0; corner < 3; ++corner)
        meshes[i].add(glm::dvec3(geometry.meshes[i].positions[triangle[corner]]));
  }
  Box world;
  for (const Instance &instance : geometry.instances) {
    if (instance.kind == ShapeKind::Plane)
      world.add(instance.to_world.translation);
    else if (instance.kind != ShapeKind::Mesh)
      add_box(world, instance.to_world, glm::dvec3(-1.0), glm::dvec3(1.0));
    else if (!meshes[instance.mesh].empty())
      add_box(world, instance.to_world, meshes[instance.mesh].low, meshes[instance.mesh].high);
  }
  // Without geometry, the positions of the lights give the scene its size.
  if (world.empty())
    for (const LightDescription &light : description.lights)
      world.add(light.to_world.translation);
  return world;
}

// Returns the centre of the bounds, and the power of two that scales the largest extent to between 512 and 1024.
Normalisation normalise(const Box &bounds) {
  Normalisation result;
  if (bounds.empty())
    return result;
  result.centre = 0.5 * bounds.low + 0.5 * bounds.high;
  const glm::dvec3 size = bounds.high - bounds.low;
  const double extent = std::max({size.x, size.y, size.z});
  if (extent > 0.0 && std::isfinite(extent))
    result.scale = std::ldexp(1.0, 9 - std::ilogb(extent));
  return result;
}

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

LightSet make_lights(Scene &scene, Description &description, const BuildContext &context) {
  EmissionAt emission(scene.node_scene(nullptr), scene.materials);
  std::vector<Light> lights;
  for (LightDescription &light : description.lights) {
    lights.push_back(place_light(light, scene.normalisation));
    add_lamp_shader(light, lights.back(), scene.normalisation, scene.lamp_shaders);
  }
  if (!scene.lamp_shaders.empty())
    parallel_for(context, lights.size(), [&](size_t i) {
      if (lights[i].shader != kNone)
        lights[i].level = mean_strength(lights[i], scene.lamp_shaders, scene.node_scene(nullptr));
    });
  return LightSet(std::move(lights), make_emitters(scene.geometry, scene.slots, scene.materials, emission, context),
                  scene.geometry.instances.size(),
                  Environment(scene.world, scene.images, scene.normalisation, context, scene.features & kFeatureGlass),
                  context);
}

} // namespace

std::shared_ptr<const Scene> commit(Description description, AcceleratorKind kind, const BuildContext &context) {
  const auto start = std::chrono::steady_clock::now();
  auto scene = std::make_shared<Scene>();
  const Features features = find_features(description);
  scene->features = features.bits;
  scene->shapes = features.shapes;
  // Displace vertices before computing bounds and lights from them.
  if (features.bits & kFeatureDisplacement)
    displace(description, context);
  flatten(description, context);
  scene->normalisation = normalise(world_bounds(description, context));
  // Make materials ready.
  scene->geometry = std::move(description.geometry);
  scene->slots = std::move(description.slots);
  scene->materials = std::move(description.materials);
  for (Material &material : scene->materials)
    material.ready = make_ready_lobes(material);
  for (size_t i = 0; i < scene->materials.size(); ++i)
    report_limits(label("material", scene->materials[i].name.c_str(), i), scene->materials[i], description.messages);
  scene->classes = shading_classes(scene->materials);
  scene->images = std::move(description.images);
  scene->cutouts = make_cutouts(scene->materials, scene->images);
  scene->transparent_instances =
      find_instances(*scene, [&](const Instance &, uint32_t material) { return scene->materials[material].is_transparent(); });
  scene->perforated_instances = find_instances(*scene, [&](const Instance &instance, uint32_t material) {
    return instance.kind == ShapeKind::Mesh && !instance.holdout && scene->cutouts[material].may_end;
  });
  scene->world = std::move(description.world);
  // Place everything in the normalised world.
  for (Instance &instance : scene->geometry.instances) {
    instance.place(scene->normalisation.to_normalised(instance.to_world));
    if (instance.kind != ShapeKind::Mesh)
      continue;
    Mesh &mesh = scene->geometry.meshes[instance.mesh];
    scene->triangles += mesh.triangles.size();
    const bool smooth = instance.shading == Shading::Gouraud || instance.shading == Shading::Phong;
    poll_cancel(context);
    if (smooth && mesh.normal_domain == NormalDomain::None && mesh.smooth_normals.empty())
      mesh.smooth_normals = normals_by_area(mesh);
    if (instance.shading == Shading::Flat && mesh.centers.empty())
      mesh.centers = polygon_centers(mesh);
  }
  scene->lights = make_lights(*scene, description, context);
  scene->accelerator = build_accelerator(kind, scene->geometry, plane_rules(*scene), context);
  scene->messages = description.messages.text();
  scene->build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return scene;
}

uint32_t Scene::face_number(uint32_t instance, uint32_t primitive) const {
  const Instance &placed = geometry.instances[instance];
  const bool renumbered = placed.kind == ShapeKind::Mesh && !geometry.meshes[placed.mesh].face_of.empty();
  return renumbered ? geometry.meshes[placed.mesh].face_of[primitive] : primitive;
}

size_t Scene::geometry_bytes() const {
  size_t bytes = geometry.instances.size() * sizeof(Instance) + geometry.object_infos.size() * sizeof(ObjectInfo) +
                 slots.size() * sizeof(uint32_t) + transparent_instances.size() + perforated_instances.size() + lights.bytes();
  for (const ObjectAttribute &attribute : geometry.object_attributes)
    bytes += attribute.values.size() * sizeof(glm::vec4);
  for (const Mesh &mesh : geometry.meshes) {
    bytes += mesh.positions.size() * sizeof(glm::vec3) + mesh.triangles.size() * sizeof(glm::uvec3) +
             (mesh.normals.size() + mesh.smooth_normals.size() + mesh.colors.size()) * sizeof(glm::vec3) +
             mesh.uvs.size() * sizeof(glm::vec2) + mesh.material_slots.size() * sizeof(uint16_t) +
             (mesh.face_of.size() + mesh.polygons.size()) * sizeof(uint32_t) + mesh.centers.size() * sizeof(PolygonCenter);
    for (const MeshAttribute &attribute : mesh.attributes)
      bytes += attribute.values.size() * sizeof(float);
  }
  return bytes;
}

size_t Scene::texture_bytes() const {
  size_t bytes = 0;
  for (const Image &image : images)
    bytes += image.blocks ? 0 : image.bytes();
  return bytes;
}

size_t Scene::mapped_bytes() const {
  size_t bytes = 0;
  for (const Image &image : images)
    bytes += image.blocks ? image.bytes() : 0;
  return bytes;
}

} // namespace lancer
