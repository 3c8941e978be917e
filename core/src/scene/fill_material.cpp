// Checks and copies materials: replaces values outside a model's range, with a message, and rejects invalid structure.
#include "scene/description.h"
#include "scene/fill.h"
#include "scene/messages.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

class MaterialReader {
public:
  MaterialReader(std::string object, const Program &program, Messages &messages)
      : object_(std::move(object)), program_(program), messages_(messages) {}

  // Each component: NaN becomes fallback, other values are clamped to [low, high]. Results of nodes are clamped when evaluated.
  Parameter read(const char *what, const lancer_parameter &given, float low, float high, float fallback) const {
    check_reference(object_, what, given, program_);
    Parameter parameter;
    parameter.node = given.node;
    if (parameter.varies())
      return parameter;
    for (int i = 0; i < 3; ++i) {
      const float value = given.value[i];
      const float used = std::isnan(value) ? fallback : std::clamp(value, low, high);
      if (!(value == used))
        messages_.add(object_, std::string(what) + " " + to_text(value) + " was replaced by " + to_text(used));
      parameter.value[i] = used;
    }
    return parameter;
  }

  Parameter read_color(const char *what, const lancer_parameter &given, float high = kBrightest) const {
    return read(what, given, 0.0f, high, 0.0f);
  }

  // Reads a scalar in value[0]; the other two components are ignored.
  Parameter read_scalar(const char *what, lancer_parameter given, float low, float high, float fallback) const {
    given.value[1] = given.value[2] = low;
    Parameter parameter = read(what, given, low, high, fallback);
    parameter.value = glm::vec3(parameter.value.x);
    return parameter;
  }

  Parameter read_share(const char *what, const lancer_parameter &given, float fallback = 0.0f) const {
    return read_scalar(what, given, 0.0f, 1.0f, fallback);
  }

  Parameter read_ior(const char *what, const lancer_parameter &given) const {
    // An index of zero or below is invalid; use the default of Blender's glass.
    const float value = given.value[0];
    lancer_parameter checked = given;
    if (given.node < 0 && !(value > 0.0f)) {
      messages_.add(object_, std::string(what) + " " + to_text(value) + " was replaced by 1.45");
      checked.value[0] = 1.45f;
    }
    return read_scalar(what, checked, 0.0f, INFINITY, 1.45f);
  }

  Parameter read_vector(const char *what, const lancer_parameter &given) const {
    return read(what, given, -kBrightest, kBrightest, 0.0f);
  }

  // fallback: replaces NaN; a colour becomes black instead, an index that of glass.
  template <ParameterKind kind> Parameter read(const char *what, const lancer_parameter &given, float fallback) const {
    if constexpr (kind == ParameterKind::Color)
      return read_color(what, given);
    else if constexpr (kind == ParameterKind::Share)
      return read_share(what, given, fallback);
    else if constexpr (kind == ParameterKind::Amount)
      return read_scalar(what, given, 0.0f, kBrightest, fallback);
    else if constexpr (kind == ParameterKind::Signed)
      return read_scalar(what, given, -1.0f, 1.0f, fallback);
    else if constexpr (kind == ParameterKind::Index || kind == ParameterKind::Denser)
      return read_ior(what, given);
    else if constexpr (kind == ParameterKind::Turns)
      return read_scalar(what, given, -kBrightest, kBrightest, fallback);
    else
      return read_vector(what, given);
  }

private:
  std::string object_;
  const Program &program_;
  Messages &messages_;
};

PrincipledDescription read_principled(const MaterialReader &reader, const lancer_principled &given) {
  PrincipledDescription principled;
  principled.rules = static_cast<Rules>(given.rules);
  principled.distribution = static_cast<Facets>(given.distribution);
  principled.option = given.option;
  principled.subsurface_option = given.subsurface_option;
#define LANCER_READ(kind, name, spoken, used) principled.name = reader.read<ParameterKind::kind>(spoken, given.name, used);
  LANCER_PRINCIPLED_PARAMETERS(LANCER_READ)
#undef LANCER_READ
  return principled;
}

LobeDescription read_lobe(const MaterialReader &reader, const lancer_lobe &given) {
  LobeDescription lobe;
  lobe.kind = static_cast<LobeKind>(given.kind);
  lobe.rules = static_cast<Rules>(given.rules);
  lobe.distribution = static_cast<Facets>(given.distribution);
  lobe.option = given.option;
  lobe.weight = reader.read_color("weight", given.weight);
  lobe.normal = reader.read_vector("normal", given.normal);
  // Check only parameters that the lobe uses, so that a value without effect gives no message.
  const bool coating = lobe.kind == LobeKind::Beckmann, blinn = lobe.kind == LobeKind::BlinnPhong,
             glass = lobe.kind == LobeKind::Glass || lobe.kind == LobeKind::Refraction,
             metal = lobe.kind == LobeKind::Glossy || lobe.kind == LobeKind::Conductor;
  const bool cloth = lobe.kind == LobeKind::Sheen || lobe.kind == LobeKind::Diffuse;
  if (metal || is_hair(lobe) || lobe.kind == LobeKind::Principled)
    lobe.tangent = reader.read_vector("tangent", given.tangent);
  if (lobe.kind == LobeKind::Principled) {
    lobe.principled = read_principled(reader, *given.principled);
    return lobe;
  }
  const bool f82 = lobe.kind == LobeKind::Conductor && lobe.option == 0;
  lobe.color = reader.read_color("colour", given.color, f82 ? 1.0f : kBrightest);
  if (coating || glass || metal || cloth)
    lobe.roughness = reader.read_share("roughness", given.roughness, 0.5f);
  if (coating || glass || lobe.kind == LobeKind::Dielectric)
    lobe.ior = reader.read_ior("IOR", given.ior);
  if (blinn || lobe.kind == LobeKind::Phong)
    lobe.shininess = reader.read_scalar("shininess", given.shininess, 0.0f, 1e8f, 32.0f);
  if (lobe.kind == LobeKind::Minnaert)
    lobe.shininess = reader.read_scalar("k", given.shininess, 0.0f, 1e8f, 1.0f);
  if (lobe.kind == LobeKind::Conductor)
    lobe.edge = reader.read_color("edge", given.edge, f82 ? 1.0f : kBrightest);
  if (lobe.kind == LobeKind::Toon) {
    lobe.roughness = reader.read_share("size", given.roughness, 0.5f);
    lobe.roughness_across = reader.read_share("smooth", given.roughness_across);
  }
  if (is_hair(lobe)) {
    lobe.roughness = reader.read_share("roughness", given.roughness, 0.2f);
    lobe.roughness_across = is_huang(lobe) ? reader.read_scalar("aspect ratio", given.roughness_across, 0.0f, kBrightest, 0.85f)
                                           : reader.read_share("roughness across", given.roughness_across, 0.2f);
    lobe.offset = reader.read_scalar("offset", given.offset, -kBrightest, kBrightest, 0.0f);
  }
  if (lobe.kind == LobeKind::HairFibre) {
    lobe.ior = reader.read_ior("IOR", given.ior);
    lobe.edge = is_huang(lobe) ? reader.read_color("factors", given.edge) : reader.read_color("edge", given.edge, 1.0f);
  }
  if (lobe.kind == LobeKind::Subsurface) {
    lobe.roughness = reader.read_share("roughness", given.roughness, 1.0f);
    lobe.ior = reader.read_ior("IOR", given.ior);
    lobe.edge = reader.read_color("radius", given.edge);
    lobe.anisotropy = reader.read_scalar("anisotropy", given.anisotropy, -1.0f, 1.0f, 0.0f);
  }
  if (lobe.kind == LobeKind::Glass || lobe.kind == LobeKind::Conductor) {
    lobe.film_thickness = reader.read_scalar("film thickness", given.film_thickness, 0.0f, kBrightest, 0.0f);
    if (may_be_positive(lobe.film_thickness))
      lobe.film_ior = reader.read_ior("film IOR", given.film_ior);
  }
  if (metal) {
    lobe.anisotropy = reader.read_scalar("anisotropy", given.anisotropy, -1.0f, 1.0f, 0.0f);
    lobe.rotation = reader.read_scalar("rotation", given.rotation, -kBrightest, kBrightest, 0.0f);
  }
  return lobe;
}

void check_lobe(const std::string &object, const lancer_lobe &lobe, uint32_t i) {
  const std::string where = object + ": lobe " + std::to_string(i) + " has ";
  const auto check = [&](const char *what, uint32_t value, uint32_t count) {
    if (value >= count)
      bad_argument(where + what + " " + std::to_string(value) + ", which is unknown");
  };
  check("kind", lobe.kind, LANCER_LOBE_KIND_COUNT);
  check("distribution", lobe.distribution, LANCER_DISTRIBUTION_MULTI_GGX + 1);
  check("option", lobe.option, lobe.kind == LANCER_SUBSURFACE ? 8 : lobe.kind == LANCER_CONDUCTOR ? 3 : 2);
  check("rules", lobe.rules, LANCER_RULES_BLENDER_52 + 1);
  if (lobe.kind != LANCER_PRINCIPLED)
    return;
  if (!lobe.principled)
    bad_argument(where + "no record: principled is NULL");
  check("distribution", lobe.principled->distribution, LANCER_DISTRIBUTION_MULTI_GGX + 1);
  check("option", lobe.principled->option, 2);
  check("subsurface option", lobe.principled->subsurface_option, 8);
  check("rules", lobe.principled->rules, LANCER_RULES_BLENDER_52 + 1);
}

// Collects all parameters of a lobe.
void collect(const LobeDescription &lobe, std::vector<Parameter> &parameters) {
  parameters.insert(parameters.end(), {lobe.weight, lobe.color, lobe.roughness, lobe.ior, lobe.shininess, lobe.edge,
                                       lobe.anisotropy, lobe.rotation, lobe.normal, lobe.tangent, lobe.roughness_across,
                                       lobe.film_thickness, lobe.film_ior, lobe.offset});
  if (!lobe.principled)
    return;
  const PrincipledDescription &p = *lobe.principled;
#define LANCER_COLLECT(kind, name, spoken, given) parameters.push_back(p.name);
  LANCER_PRINCIPLED_PARAMETERS(LANCER_COLLECT)
#undef LANCER_COLLECT
}

// Whether a sheet of glass may be so smooth that rays pass it straight: by its facets, or by an index near 1. A sheet beyond
// both limits has an alpha above 3e-5 (sheet.h), more than that of a mirror.
bool may_be_smooth_sheet(const PrincipledDescription &p) {
  constexpr float kRoughSheet = 0.02f, kBentSheet = 1.01f;
  const bool smooth = p.roughness.varies() || p.ior.varies() || p.roughness.value.x < kRoughSheet || p.ior.value.x < kBentSheet;
  return may_be_positive(p.thin_wall) && may_be_positive(p.transmission) && smooth;
}

void make_schedules(Material &material) {
  const auto schedule = [&](std::vector<Parameter> parameters) { return material.program.schedule(parameters); };
  std::vector<Parameter> surface{material.emission, material.transmittance, material.holdout, material.ambient,
                                 material.normal};
  std::vector<Parameter> emission{material.emission}, transmittance{material.transmittance};
  for (const Portal &portal : material.portals) {
    surface.insert(surface.end(), {portal.weight, portal.position, portal.direction});
    transmittance.push_back(portal.weight);
  }
  for (const LobeDescription &lobe : material.lobes) {
    collect(lobe, surface);
    const bool bent = lobe.normal.varies() || lobe.normal.value != glm::vec3(0.0f) || material.normal.varies();
    material.bends_exits |= goes_below(lobe) && bent;
    material.estimates |= is_huang(lobe);
    if (!lobe.principled)
      continue;
    const Parameter &below = lobe.principled->emission;
    material.layered_emission |= below.varies() || below.value != glm::vec3(0.0f);
    material.has_sheets |= may_be_smooth_sheet(*lobe.principled);
    emission.push_back(below);
  }
  material.surface_nodes = schedule(std::move(surface));
  material.transmittance_nodes = schedule(std::move(transmittance));
  material.emission_nodes = schedule(std::move(emission));
  material.displacement_nodes = schedule({material.displacement});
  material.output_nodes = schedule_of(material.outputs, material.program);
}

} // namespace

Material read_material(const lancer_material &source, size_t number, Images images, Messages &messages) {
  const std::string object = label("material", source.name, number);
  if (source.lobe_count > uint32_t(kMaxLobes))
    bad_argument(object + ": " + std::to_string(source.lobe_count) + " lobes > " + std::to_string(kMaxLobes));
  if (source.lobe_count && !source.lobes)
    bad_argument(object + ": lobes is NULL for " + std::to_string(source.lobe_count) + " lobes");
  for (uint32_t i = 0; i < source.lobe_count; ++i)
    check_lobe(object, source.lobes[i], i);
  check_flags(object + ": ", source.flags,
              LANCER_MATERIAL_NO_BUMP_CORRECTION | LANCER_MATERIAL_NOT_A_LIGHT | LANCER_MATERIAL_OPAQUE_SHADOWS |
                  LANCER_MATERIAL_KEEP_NORMALS);

  if (source.portal_count > uint32_t(kMaxLobes))
    bad_argument(object + ": " + std::to_string(source.portal_count) + " portals > " + std::to_string(kMaxLobes));
  if (source.portal_count && !source.portals)
    bad_argument(object + ": portals is NULL for " + std::to_string(source.portal_count) + " portals");

  Material material;
  material.name = source.name ? source.name : "";
  material.index = source.material_index;
  material.matte = source.matte;
  material.flags = source.flags;
  material.program = read_program(images, object, source.nodes, source.node_count);
  const MaterialReader reader(object, material.program, messages);
  for (uint32_t i = 0; i < source.lobe_count; ++i)
    material.lobes.push_back(read_lobe(reader, source.lobes[i]));
  material.emission = reader.read_vector("emission", source.emission);
  material.transmittance = reader.read_color("transmittance", source.transmittance);
  material.holdout = reader.read_share("holdout", source.holdout);
  material.ambient = reader.read_color("ambient", source.ambient);
  material.displacement = reader.read_vector("displacement", source.displacement);
  material.normal = reader.read_vector("normal", source.normal);
  for (uint32_t i = 0; i < source.portal_count; ++i) {
    const lancer_portal &given = source.portals[i];
    material.portals.push_back({(given.moves & 1) != 0, reader.read_color("portal weight", given.weight),
                                reader.read_vector("portal position", given.position),
                                reader.read_vector("portal direction", given.direction)});
  }
  material.outputs = read_outputs(object, source.outputs, source.output_count, material.program);
  make_schedules(material);
  return material;
}

void add_material(Description &description, const lancer_material &source) {
  Messages messages; // discarded if the material is rejected
  Material material = read_material(source, description.materials.size(), description.images, messages);
  description.materials.emplace_back(std::move(material), std::move(messages));
}

} // namespace lancer
