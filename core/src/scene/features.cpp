#include "scene/features.h"

#include "scene/description.h"

namespace lancer {

namespace {

uint32_t shape_feature(ShapeKind kind) {
  switch (kind) {
  case ShapeKind::Mesh:
    return kFeatureTriangles;
  case ShapeKind::Sphere:
    return kFeatureSpheres;
  case ShapeKind::Plane:
    return kFeaturePlanes;
  case ShapeKind::Cylinder:
    return kFeatureCylinders;
  case ShapeKind::Cone:
    return kFeatureCones;
  }
  return 0;
}

} // namespace

uint32_t find_features(const Description &description) {
  uint32_t features = 0;
  // Look at what is placed: a mesh or material that nothing shows costs nothing.
  std::vector<uint32_t> uses(description.geometry.meshes.size());
  std::vector<bool> shown(description.materials.size());
  for (const Instance &instance : description.geometry.instances) {
    features |= shape_feature(instance.kind);
    if (instance.kind == ShapeKind::Mesh) {
      if (++uses[instance.mesh] > 1)
        features |= kFeatureInstances;
      if (!description.geometry.meshes[instance.mesh].colors.empty())
        features |= kFeatureVertexColors;
    }
    for (uint32_t slot = 0; slot < instance.slot_count; ++slot)
      shown[description.slots[instance.first_slot + slot]] = true;
  }
  for (size_t i = 0; i < shown.size(); ++i) {
    const Material &material = description.materials[i];
    if (!shown[i])
      continue;
    for (const LobeDescription &lobe : material.lobes)
      features |= 1u << uint32_t(lobe.kind);
    if (material.opacity.value.x < 1.0f)
      features |= kFeatureOpacity;
    if (material.emits())
      features |= kFeatureEmitters;
  }
  for (const LightDescription &light : description.lights)
    features |= kFeaturePointLights << uint32_t(light.kind);
  if (description.world != glm::vec3(0.0f))
    features |= kFeatureEnvironment;
  return features;
}

std::string feature_names(uint32_t features) {
  static const char *const names[] = {"lambert",     "beckmann",    "mirror",    "dielectric",   "phong",
                                      "blinn-phong", "opacity",     "triangles", "instances",    "spheres",
                                      "planes",      "cylinders",   "cones",     "point-lights", "spot-lights",
                                      "sun-lights",  "area-lights", "emitters",  "environment",  "vertex-colors"};
  std::string text;
  for (uint32_t bit = 0; bit < std::size(names); ++bit) {
    if (!(features & (1u << bit)))
      continue;
    if (!text.empty())
      text += ' ';
    text += names[bit];
  }
  return text;
}

} // namespace lancer
