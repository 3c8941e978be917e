// What of a material's lobes is the same wherever the material is met, made once when the scene is committed.
#pragma once

#include "bsdf/cached_plans.h"

#include <string>
#include <vector>

namespace lancer {

struct Material;

// Which inputs of a lobe are other than nothing: the rest need not be read.
struct LobeParts {
  LobeParts() = default;
  LobeParts(const LobeInputs<float> &inputs, const PrincipledInputs<float> &in);
  bool normal = false, tangent = false;
  // Of Principled alone.
  bool coat_normal = false, coat_tint = false, diffuse_roughness = false, emission = false, sheen = false, coat = false,
       metal = false, glass = false;
};

struct ReadyLobe {
  // As nodes leave them: what varies is 0 here.
  LobeInputs<float> inputs;
  PrincipledInputs<float> principled;
  LobeParts parts;
  // By side (outside, inside) and Layer. Of facets of other nodes the only one is that of PrincipledLayer::Gloss.
  std::shared_ptr<const CachedPlan> plans[2][kLayerCount];

  // What code it needs, as far as nodes do not decide it: lobes of one code differ in numbers alone.
  std::string code() const;

  bool has(PrincipledLayer layer) const { return plans[0][static_cast<int>(layer)] != nullptr; }
  const CachedPlan *plan(PrincipledLayer layer, bool inside) const { return plans[inside][static_cast<int>(layer)].get(); }
};

// One for each lobe.
std::shared_ptr<const ReadyLobe[]> make_ready_lobes(const Material &material);

// A lobe of every lane, all of one code.
template <class F> struct LaneLobes : LaneRecords<F, ReadyLobe> {
  using LaneRecords<F, ReadyLobe>::of, LaneRecords<F, ReadyLobe>::same;
  using LaneRecords<F, ReadyLobe>::number, LaneRecords<F, ReadyLobe>::vector;

  uint32_t inside = 0; // bits of lanes

  // The inputs of lobes without nodes.
#define LANCER_OF(member)                                                                                                      \
  [](const ReadyLobe &r) __attribute__((always_inline)) { return r.member; }
  LANCER_LANE LobeInputs<F> inputs() const {
    const LobeInputs<float> &first = of[0]->inputs;
    LobeInputs<F> in;
    in.kind = first.kind;
    in.rules = first.rules;
    in.distribution = first.distribution;
    in.option = first.option;
    in.weight = vector(LANCER_OF(inputs.weight));
    in.color = vector(LANCER_OF(inputs.color));
    if (of[0]->parts.normal)
      in.normal = vector(LANCER_OF(inputs.normal));
    if (of[0]->parts.tangent)
      in.tangent = vector(LANCER_OF(inputs.tangent));
    if (first.kind == LobeKind::Lambert)
      return in;
    in.roughness = number(LANCER_OF(inputs.roughness));
    in.ior = number(LANCER_OF(inputs.ior));
    in.shininess = number(LANCER_OF(inputs.shininess));
    in.edge = vector(LANCER_OF(inputs.edge));
    in.anisotropy = number(LANCER_OF(inputs.anisotropy));
    in.rotation = number(LANCER_OF(inputs.rotation));
    return in;
  }
  // Of Principled: what all of its layers share, beside what principled() reads.
  LANCER_LANE LobeInputs<F> principled_carrier() const {
    const LobeInputs<float> &first = of[0]->inputs;
    const LobeParts &parts = of[0]->parts;
    LobeInputs<F> in;
    in.kind = first.kind;
    in.rules = first.rules;
    in.weight = vector(LANCER_OF(inputs.weight));
    if (parts.normal)
      in.normal = vector(LANCER_OF(inputs.normal));
    if (parts.tangent)
      in.tangent = vector(LANCER_OF(inputs.tangent));
    return in;
  }
  LANCER_LANE PrincipledInputs<F> principled() const {
    const ReadyLobe &first = *of[0];
    const LobeParts &parts = first.parts;
    PrincipledInputs<F> in;
    in.rules = first.principled.rules;
    in.distribution = first.principled.distribution;
    in.option = first.principled.option;
    in.base_color = vector(LANCER_OF(principled.base_color));
    const bool old = in.rules == Rules::Blender3;
    if (parts.metal)
      in.metallic = number(LANCER_OF(principled.metallic));
    if (parts.glass)
      in.transmission = number(LANCER_OF(principled.transmission));
    if (parts.coat)
      in.coat = number(LANCER_OF(principled.coat));
    if (parts.coat_tint)
      in.coat_tint = vector(LANCER_OF(principled.coat_tint));
    if (parts.coat_normal)
      in.coat_normal = vector(LANCER_OF(principled.coat_normal));
    if (parts.diffuse_roughness)
      in.diffuse_roughness = number(LANCER_OF(principled.diffuse_roughness));
    if (parts.emission)
      in.emission = vector(LANCER_OF(principled.emission));
    if (parts.sheen) {
      in.sheen = number(LANCER_OF(principled.sheen));
      in.sheen_roughness = number(LANCER_OF(principled.sheen_roughness));
      in.sheen_tint = vector(LANCER_OF(principled.sheen_tint));
    }
    // The rest is in plans, where those are kept.
    const bool planned =
        !old && first.has(PrincipledLayer::Gloss) && (!parts.coat || first.has(PrincipledLayer::Coat)) && !parts.tangent;
    if (planned)
      return in;
    in.roughness = number(LANCER_OF(principled.roughness));
    in.ior = number(LANCER_OF(principled.ior));
    in.specular = number(LANCER_OF(principled.specular));
    in.specular_tint = vector(LANCER_OF(principled.specular_tint));
    in.anisotropic = number(LANCER_OF(principled.anisotropic));
    in.anisotropic_rotation = number(LANCER_OF(principled.anisotropic_rotation));
    in.transmission_roughness = number(LANCER_OF(principled.transmission_roughness));
    in.coat_roughness = number(LANCER_OF(principled.coat_roughness));
    in.coat_ior = number(LANCER_OF(principled.coat_ior));
    return in;
  }
#undef LANCER_OF

  // The layers that are planned: as of add_layers().
  LANCER_LANE bool has(PrincipledLayer layer) const { return of[0]->has(layer); }
  LANCER_LANE Lobe<F> seen(PrincipledLayer layer, F cos_o, const Vec3<F> &color) const {
    constexpr uint32_t all_inside = (1u << LanesOf<F>::kWidth) - 1u;
    LanePlans<F> plans;
    plans.of[0] = of[0]->plan(layer, inside & 1);
    plans.same = same && (inside == 0 || inside == all_inside);
    for (int i = 1; i < LanesOf<F>::kWidth && !plans.same; ++i)
      plans.of[i] = of[same ? 0 : i]->plan(layer, inside >> i & 1);
    return plans.seen(cos_o, color);
  }
};

} // namespace lancer
