#include "compile/features.h"

#include "bsdf/lobe.h"
#include "bsdf/material_lobes.h"
#include "scene/description.h"
#include "scene/enums.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace lancer {

bool is_glass(const LobeDescription &lobe) {
  return lobe.kind == LobeKind::Dielectric || lobe.kind == LobeKind::Glass || lobe.kind == LobeKind::Refraction ||
         (lobe.principled && may_be_positive(lobe.principled->transmission));
}

namespace {

// Whether the diffuse light of a sheet may pass to its other side.
bool is_matt_sheet(const PrincipledDescription &principled) {
  return may_be_positive(principled.thin_wall) && may_be_positive(principled.wall_scattering);
}

} // namespace

bool lets_light_through(const MaterialView &material) {
  return material.is_transparent() || std::any_of(material.lobes.begin(), material.lobes.end(), is_glass);
}

namespace {

std::string code_of(const MaterialView &material, size_t number) {
  std::string code = material.flags & MaterialFlag::NoBumpCorrection ? "u" : "c";
  if (!material.fixed())
    return code + std::to_string(number);
  for (size_t i = 0; i < material.lobes.size(); ++i)
    code += material.ready[i].code() + ' ';
  return code;
}

} // namespace

std::vector<uint32_t> shading_classes(std::span<const MaterialView> materials) {
  std::map<std::string, uint32_t> numbers;
  std::vector<uint32_t> classes;
  for (size_t i = 0; i < materials.size(); ++i)
    classes.push_back(numbers.try_emplace(code_of(materials[i], i), uint32_t(numbers.size())).first->second);
  return classes;
}

namespace {

// Returns the lobe shapes that a kind can become.
uint32_t shapes_of(LobeKind kind) {
  switch (kind) {
  case LobeKind::Lambert:
    return shape_bit(LobeShape::Lambert);
  case LobeKind::Beckmann:
    return shape_bit(LobeShape::Beckmann);
  case LobeKind::Mirror:
    return shape_bit(LobeShape::Mirror);
  case LobeKind::Dielectric:
    return shape_bit(LobeShape::Dielectric);
  case LobeKind::Phong:
    return shape_bit(LobeShape::Phong);
  case LobeKind::BlinnPhong:
    return shape_bit(LobeShape::BlinnPhong);
  case LobeKind::Diffuse:
    return shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Matte);
  case LobeKind::Glossy:
    return shape_bit(LobeShape::Microfacet) | shape_bit(LobeShape::Ashikhmin);
  case LobeKind::Glass:
  case LobeKind::Refraction:
  case LobeKind::Conductor:
    return shape_bit(LobeShape::Microfacet);
  case LobeKind::Sheen:
    return shape_bit(LobeShape::Sheen) | shape_bit(LobeShape::Matte);
  case LobeKind::Translucent:
  case LobeKind::Minnaert:
    return shape_bit(LobeShape::Matte);
  case LobeKind::Toon:
    return shape_bit(LobeShape::Toon);
  case LobeKind::Hair:
  case LobeKind::HairFibre:
    return shape_bit(LobeShape::Hair);
  case LobeKind::Subsurface:
    return shape_bit(LobeShape::Subsurface) | shape_bit(LobeShape::Lambert);
  case LobeKind::Principled:
    return shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Matte) | shape_bit(LobeShape::Microfacet) |
           shape_bit(LobeShape::Ashikhmin) | shape_bit(LobeShape::Sheen);
  }
  return kAllShapes;
}

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

bool uses_images(const ProgramView &program) {
  for (const Node &node : program.nodes)
    if (node.kind == NodeKind::Image || node.kind == NodeKind::Environment)
      return true;
  return false;
}

// Whether some layer of the Principled BSDF may have facets.
bool may_reflect(const PrincipledDescription &principled) {
  const bool plastic = may_be_positive(principled.specular) && (principled.ior.varies() || principled.ior.value.x != 1.0f);
  return plastic || may_be_positive(principled.film_thickness) || may_be_positive(principled.metallic) ||
         may_be_positive(principled.transmission) || may_be_positive(principled.coat);
}

// Returns the shapes that a Principled lobe can become, without those of its absent layers.
uint32_t principled_shapes(const PrincipledDescription &principled) {
  uint32_t shapes = shapes_of(LobeKind::Principled);
  if (may_be_positive(principled.subsurface))
    shapes |= shape_bit(LobeShape::Subsurface);
  if (principled.rules == Rules::Blender3)
    return shapes;
  shapes &= ~shape_bit(LobeShape::Ashikhmin);
  if (!may_reflect(principled))
    shapes &= ~shape_bit(LobeShape::Microfacet);
  if (!may_be_positive(principled.diffuse_roughness) && !is_matt_sheet(principled))
    shapes &= ~shape_bit(LobeShape::Matte);
  if (!may_be_positive(principled.sheen))
    shapes &= ~shape_bit(LobeShape::Sheen);
  return shapes;
}

uint32_t shapes_of(const LobeDescription &lobe) {
  return lobe.principled ? principled_shapes(*lobe.principled) : shapes_of(lobe.kind);
}

void add_material(const MaterialView &material, Features &features) {
  for (const LobeDescription &lobe : material.lobes) {
    features.shapes |= shapes_of(lobe);
    if (is_glass(lobe))
      features.bits |= kFeatureGlass;
    if (goes_below(lobe))
      features.bits |= kFeatureSubsurface;
  }
  if (material.is_transparent())
    features.bits |= kFeatureTransparency;
  if (!material.portals.empty())
    features.bits |= kFeaturePortals;
  if (material.emits())
    features.bits |= kFeatureEmitters;
  if (!material.program.nodes.empty())
    features.bits |= kFeatureNodes;
  if (uses_images(material.program))
    features.bits |= kFeatureTextures;
  if (material.program.mipmapped)
    features.bits |= kFeatureMipmaps;
  if (material.displaces())
    features.bits |= kFeatureDisplacement;
  if (material.holdout.varies() || material.holdout.value.x > 0.0f)
    features.bits |= kFeatureHoldout;
}

} // namespace

bool has_facets(const MaterialView &material) {
  return std::ranges::any_of(material.lobes, [](const LobeDescription &lobe) {
    return (shapes_of(lobe) & (shape_bit(LobeShape::Microfacet) | shape_bit(LobeShape::Ashikhmin))) != 0;
  });
}

Features find_features(const Description &description) {
  Features features;
  // Count only meshes and materials that some instance uses.
  std::vector<uint32_t> uses(description.meshes.size());
  std::vector<bool> shown(description.materials.size());
  for (const Instance &instance : description.instances) {
    features.bits |= shape_feature(instance.kind);
    if (instance.hidden_from)
      features.bits |= kFeatureVisibility;
    if (instance.holdout)
      features.bits |= kFeatureHoldout;
    if (instance.catcher)
      features.bits |= kFeatureCatchers;
    if (instance.key_count > 0 || (instance.kind == ShapeKind::Mesh && description.meshes[instance.mesh]->key_count > 0))
      features.bits |= kFeatureMotion;
    if (instance.kind == ShapeKind::Mesh) {
      if (++uses[instance.mesh] > 1)
        features.bits |= kFeatureInstances;
      if (!description.meshes[instance.mesh]->colors.empty())
        features.bits |= kFeatureVertexColors;
    }
    for (uint32_t slot = 0; slot < instance.slot_count; ++slot)
      shown[description.slots[instance.first_slot + slot]] = true;
  }
  for (size_t i = 0; i < shown.size(); ++i)
    if (shown[i])
      add_material(*description.materials[i], features);
  for (const Given<LightDescription> &light : description.lights)
    features.bits |= light->opening ? kFeatureOpenings : kFeaturePointLights << uint32_t(light->kind);
  const World &world = *description.world;
  if (world.varies() || world.radiance.value != glm::vec3(0.0f))
    features.bits |= kFeatureEnvironment;
  if (world.varies())
    features.bits |= kFeatureEnvironmentMap;
  if (world.program.mipmapped)
    features.bits |= kFeatureMipmaps;
  return features;
}

std::string feature_names(const Features &features) {
  static const char *const shapes[] = {"lambert",    "beckmann",  "mirror", "dielectric", "phong", "blinn-phong", "matte",
                                       "microfacet", "ashikhmin", "sheen",  "toon",       "hair",  "subsurface"};
  static const char *const bits[] = {
      "transparency",  "triangles",   "instances",  "spheres",      "planes",         "cylinders",   "cones",
      "point-lights",  "spot-lights", "sun-lights", "area-lights",  "emitters",       "environment", "environment-map",
      "vertex-colors", "nodes",       "textures",   "displacement", "holdout",        "visibility",  "glass",
      "portals",       "walks",       "mipmaps",    "motion",       "shadow-catchers", "openings"};
  static_assert(std::size(shapes) == kLobeShapes);
  std::string text;
  const auto add = [&](const char *name) {
    if (!text.empty())
      text += ' ';
    text += name;
  };
  for (uint32_t bit = 0; bit < std::size(shapes); ++bit)
    if (features.shapes & (1u << bit))
      add(shapes[bit]);
  for (uint32_t bit = 0; bit < std::size(bits); ++bit)
    if (features.bits & (1u << bit))
      add(bits[bit]);
  return text;
}

} // namespace lancer
