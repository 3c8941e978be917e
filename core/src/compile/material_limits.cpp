#include "compile/steps.h"

#include "bsdf/lobe.h"

#include <set>
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
  // Before Blender 4, plastic and metal are one lobe, and glass can be two.
  return size_t(sheen) + size_t(coat) + size_t(metal && !old) + (glass ? (old ? 2 : 1) : 0) + 2;
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
    old ? frames.reflecting(lobe.normal) : frames.wide(lobe.normal);
    return 1;
  case LobeKind::Glossy:
  case LobeKind::Conductor:
    if (lobe.anisotropy.varies() || lobe.anisotropy.value.x != 0.0f)
      frames.stretched(lobe.normal, lobe.tangent, lobe.rotation);
    else
      frames.reflecting(lobe.normal);
    return 1;
  case LobeKind::Glass:
    frames.reflecting(lobe.normal);
    return old && lobe.distribution != Facets::MultiGgx ? 2 : 1;
  default:
    frames.reflecting(lobe.normal);
    return 1;
  }
}

} // namespace

MaterialDemand demand_of(const Material &material) {
  Frames frames;
  MaterialDemand demand;
  for (const LobeDescription &lobe : material.lobes)
    if (lobe.weight.varies() || lobe.weight.value != glm::vec3(0.0f))
      demand.lobes += add_lobe(lobe, frames);
  demand.frames = frames.count();
  return demand;
}

void report_limits(const std::string &object, const Material &material, Messages &messages) {
  const MaterialDemand demand = demand_of(material);
  if (demand.lobes > size_t(kMaxLobes))
    messages.add(object, std::to_string(demand.lobes) + " lobes may overlap in one place; only the first " +
                             std::to_string(kMaxLobes) + " are used");
  if (demand.frames > size_t(kMaxFrames))
    messages.add(object, std::to_string(demand.frames) + " normals may overlap in one place; lobes beyond the first " +
                             std::to_string(kMaxFrames) + " normals use the shading normal");
}

} // namespace lancer
