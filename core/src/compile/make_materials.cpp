// Materials made ready: the parts of their lobes that no hit changes, and the reports of lobes beyond the limits.
#include "bsdf/lobe.h"
#include "compile/steps.h"
#include "scene/material.h"

#include <set>
#include <span>
#include <tuple>

namespace lancer {

namespace {

using Key = std::tuple<int32_t, float, float, float>;

// Parameters with equal keys always have equal values.
Key key_of(const Parameter &parameter) {
  if (parameter.varies())
    return {parameter.node, 0.0f, 0.0f, 0.0f};
  return {-1, parameter.value.x, parameter.value.y, parameter.value.z};
}

// Collects the distinct frames of a material's lobes. A reflecting lobe may bend its normal towards the surface, which makes
// another frame.
class Frames {
public:
  Frames() { wide(Parameter()); }

  void wide(const Parameter &normal) { add(normal, Parameter(), 0); }
  void reflecting(const Parameter &normal) { add(normal, Parameter(), 1); }
  // A normal between two others.
  void between(const Parameter &a, const Parameter &b) { add(a, b, 2); }
  // rotation turns the tangent about the normal.
  void stretched(const Parameter &normal, const Parameter &tangent, const Parameter &rotation) {
    turned_.emplace(key_of(normal), key_of(tangent), key_of(rotation));
  }
  size_t count() const { return plain_.size() + turned_.size(); }

private:
  void add(const Parameter &a, const Parameter &b, int how) { plain_.emplace(key_of(a), key_of(b), how); }

  std::set<std::tuple<Key, Key, int>> plain_;
  std::set<std::tuple<Key, Key, Key>> turned_;
};

// Adds the frames of the Principled BSDF's layers, top to bottom, and returns the number of its lobes.
size_t add_principled(const LobeDescription &lobe, const PrincipledDescription &in, Frames &frames) {
  const bool old = in.rules == Rules::Blender3;
  const bool metal = may_be_positive(in.metallic), glass = may_be_positive(in.transmission);
  const bool sheen = may_be_positive(in.sheen), coat = may_be_positive(in.coat);
  if (sheen && !old && key_of(lobe.normal) != key_of(in.coat_normal))
    frames.between(lobe.normal, in.coat_normal);
  if (coat)
    frames.reflecting(in.coat_normal);
  if (may_be_positive(in.anisotropic))
    frames.stretched(lobe.normal, lobe.tangent, in.anisotropic_rotation);
  if (!may_be_positive(in.anisotropic) || (old && glass))
    frames.reflecting(lobe.normal);
  if (!old)
    frames.wide(lobe.normal);
  // Two lobes of a glass sheet and two of a matt one stand beside those of lanes without a wall.
  const size_t sheet = may_be_positive(in.thin_wall) ? 4 : 0;
  // Before Blender 4, plastic and metal are one lobe, and glass can be two.
  // The light below a surface has a lobe for the channels that walk, one for the others, and before Blender 4 a third.
  const size_t below = may_be_positive(in.subsurface) ? (old ? 3 : 2) : 0;
  return sheet + below + size_t(sheen) + size_t(coat) + size_t(metal && !old) + (glass ? (old ? 2 : 1) : 0) + 2;
}

size_t add_lobe(const LobeDescription &lobe, Frames &frames) {
  const bool old = lobe.rules == Rules::Blender3;
  switch (lobe.kind) {
  case LobeKind::Principled:
    return add_principled(lobe, *lobe.principled, frames);
  case LobeKind::Lambert:
  case LobeKind::Diffuse:
  case LobeKind::Sheen:
  case LobeKind::Minnaert:
  case LobeKind::Toon:
    old ? frames.reflecting(lobe.normal) : frames.wide(lobe.normal);
    return 1;
  case LobeKind::Glossy:
  case LobeKind::Conductor:
    if (lobe.anisotropy.varies() || lobe.anisotropy.value.x != 0.0f)
      frames.stretched(lobe.normal, lobe.tangent, lobe.rotation);
    else
      frames.reflecting(lobe.normal);
    return 1;
  case LobeKind::HairFibre:
    frames.stretched(lobe.normal, lobe.tangent, lobe.rotation);
    return 1;
  case LobeKind::Subsurface:
    frames.reflecting(lobe.normal);
    return 2;
  case LobeKind::Glass:
    frames.reflecting(lobe.normal);
    return old && lobe.distribution != Facets::MultiGgx ? 2 : 1;
  default:
    frames.reflecting(lobe.normal);
    return 1;
  }
}

} // namespace

MaterialDemand demand_of(const MaterialView &material) {
  Frames frames;
  MaterialDemand demand;
  for (const LobeDescription &lobe : material.lobes)
    if (lobe.weight.varies() || lobe.weight.value != glm::vec3(0.0f))
      demand.lobes += add_lobe(lobe, frames);
  demand.frames = frames.count();
  return demand;
}

void report_limits(const std::string &object, const MaterialView &material, Messages &messages) {
  const MaterialDemand demand = demand_of(material);
  if (demand.lobes > size_t(kMaxLobes))
    messages.add(object, std::to_string(demand.lobes) + " lobes may overlap in one place; only the first " +
                             std::to_string(kMaxLobes) + " are used");
  if (demand.frames > size_t(kMaxFrames))
    messages.add(object, std::to_string(demand.frames) + " normals may overlap in one place; lobes beyond the first " +
                             std::to_string(kMaxFrames) +
                             " normals use the shading normal, and fibres among them are left out");
}

namespace {

bool vary(std::initializer_list<const Parameter *> parameters) {
  return std::any_of(parameters.begin(), parameters.end(), [](const Parameter *parameter) { return parameter->varies(); });
}

// Whether nodes change the plan of a layer.
bool varies(PrincipledLayer layer, const LobeDescription &lobe) {
  const PrincipledDescription &p = *lobe.principled;
  const bool film = may_be_positive(p.film_thickness) && vary({&p.film_thickness, &p.film_ior});
  const bool grain = vary({&p.roughness, &p.anisotropic, &lobe.tangent}) || film;
  switch (layer) {
  case PrincipledLayer::Coat:
    return vary({&p.coat_roughness, &p.coat_ior});
  case PrincipledLayer::Metal:
    return grain || vary({&p.base_color, &p.specular_tint});
  case PrincipledLayer::Glass:
    return film || vary({&p.roughness, &p.ior, &p.specular_tint, &p.base_color});
  default:
    return grain || vary({&p.ior, &p.specular, &p.specular_tint});
  }
}

const Parameter *share_parameter(PrincipledLayer layer, const PrincipledDescription &p) {
  switch (layer) {
  case PrincipledLayer::Coat:
    return &p.coat;
  case PrincipledLayer::Metal:
    return &p.metallic;
  case PrincipledLayer::Glass:
    return &p.transmission;
  default:
    return nullptr;
  }
}

const CachedPlan *keep(ReadyLobes &all, const MicrofacetPlan<float> &plan) {
  return all.plans.emplace_back(cached(plan)).get();
}

void cache_layers(const LobeDescription &lobe, ReadyLobe &ready, ReadyLobes &all) {
  for (const LayerRow &row : kLayers) {
    const Parameter *share = share_parameter(row.layer, *lobe.principled);
    const bool may_be_there = share_of(row.layer, ready.principled) > kLeastLayer || (share && share->varies());
    if (!row.facets || !may_be_there || varies(row.layer, lobe))
      continue;
    // A plastic layer with an index of refraction of 1 is absent, unless it has a film.
    if (row.layer == PrincipledLayer::Gloss && !has_gloss(ready.principled))
      continue;
    for (const bool inside : {false, true})
      ready.plans[inside][static_cast<int>(row.layer)] =
          keep(all, plan_layer(row.layer, ready.inputs, ready.principled, inside));
  }
}

// Plans the facets of a lobe whose inputs are constant and which has no direction along the surface.
void cache_facets(ReadyLobe &ready, ReadyLobes &all) {
  const LobeInputs<float> &inputs = ready.inputs;
  const bool glass = inputs.kind == LobeKind::Glass, conductor = inputs.kind == LobeKind::Conductor;
  const bool glossy = inputs.kind == LobeKind::Glossy && inputs.distribution != Facets::AshikhminShirley;
  if (inputs.rules == Rules::Blender3 || (!glass && (inputs.anisotropy != 0.0f || !(conductor || glossy))))
    return;
  for (const bool inside : {false, true})
    ready.plans[inside][static_cast<int>(PrincipledLayer::Gloss)] = keep(all, plan_facets(inputs, inside));
}

} // namespace

LobeParts::LobeParts(const LobeInputs<float> &inputs, const PrincipledInputs<float> &in) {
  const glm::vec3 none(0.0f);
  const bool is_principled = inputs.kind == LobeKind::Principled;
  normal = inputs.normal != none;
  tangent = inputs.tangent != none && (!is_principled || in.anisotropic > 0.0f);
  across = inputs.roughness_across != 0.0f || inputs.offset != 0.0f;
  film = (is_principled ? in.film_thickness : inputs.film_thickness) > kThinnestFilm;
  if (!is_principled)
    return;
  sheet = in.thin_wall > 0.0f;
  below = in.subsurface > 0.0f;
  coat_normal = in.coat_normal != none;
  coat_tint = in.coat_tint != glm::vec3(1.0f);
  diffuse_roughness = in.diffuse_roughness != 0.0f;
  emission = in.emission != none;
  sheen = in.sheen > kLeastLayer;
  coat = in.coat > kLeastLayer;
  metal = in.metallic > (in.rules == Rules::Blender3 ? 0.0f : kLeastLayer);
  glass = in.transmission > (in.rules == Rules::Blender3 ? 0.0f : kLeastLayer);
}

std::string ReadyLobe::code() const {
  std::string code;
  const auto add = [&](auto number) { code += char('0' + int(number)); };
  const bool is_principled = inputs.kind == LobeKind::Principled;
  add(inputs.kind);
  add(is_principled ? principled.rules : inputs.rules);
  add(is_principled ? principled.distribution : inputs.distribution);
  add(is_principled ? principled.option : inputs.option);
  add(principled.subsurface_option);
  for (const auto &plan : plans[0])
    add(plan != nullptr);
  for (const bool part :
       {parts.normal, parts.tangent, parts.coat_normal, parts.coat_tint, parts.diffuse_roughness, parts.emission, parts.sheen,
        parts.coat, parts.metal, parts.glass, parts.film, parts.across, parts.sheet, parts.below})
    add(part);
  return code;
}

ReadyLobes make_ready_lobes(const MaterialView &material) {
  // Placeholders for the results of nodes. Values derived from a placeholder are not used.
  const std::vector<glm::vec4> nothing(material.program.nodes.size(), glm::vec4(0.0f));
  ReadyLobes all;
  all.lobes.resize(material.lobes.size());
  for (size_t i = 0; i < material.lobes.size(); ++i) {
    const LobeDescription &lobe = material.lobes[i];
    ReadyLobe &ready = all.lobes[i];
    ready.inputs = evaluate(lobe, nothing);
    if (lobe.principled)
      ready.principled = evaluate(*lobe.principled, nothing);
    ready.parts = LobeParts(ready.inputs, ready.principled);
    if (lobe.principled && lobe.principled->rules != Rules::Blender3)
      cache_layers(lobe, ready, all);
    else if (!lobe.principled && material.fixed())
      cache_facets(ready, all);
  }
  return all;
}

} // namespace lancer
