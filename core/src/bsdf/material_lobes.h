// The lobes of a material: the parts that are the same at every hit, which commit computes, and the lobes at a hit. F is a
// float, or lanes of floats whose materials are of one class.
#pragma once

#include "bsdf/cached_plans.h"
#include "bsdf/limited_lobes.h"
#include "bsdf/principled.h"
#include "scene/material.h"

#include <string>
#include <vector>

namespace lancer {

// Flags of the lobe inputs that differ from their neutral value; the others need not be read.
struct LobeParts {
  LobeParts() = default;
  LobeParts(const LobeInputs<float> &inputs, const PrincipledInputs<float> &in);
  bool normal = false, tangent = false, film = false, across = false;
  // Only of Principled.
  bool coat_normal = false, coat_tint = false, diffuse_roughness = false, emission = false, sheen = false, coat = false,
       metal = false, glass = false, sheet = false, below = false;
};

struct ReadyLobe {
  // The inputs that are constants; an input that varies is 0.
  LobeInputs<float> inputs;
  PrincipledInputs<float> principled;
  LobeParts parts;
  // By side (outside, inside) and Layer. The facets of other lobes are stored at PrincipledLayer::Gloss.
  const CachedPlan *plans[2][kLayerCount] = {};

  // Returns a key of the code that the lobe runs, as far as it does not depend on results of nodes. Lobes with equal keys
  // differ in numbers alone.
  std::string code() const;

  bool has(PrincipledLayer layer) const { return plans[0][static_cast<int>(layer)] != nullptr; }
  const CachedPlan *plan(PrincipledLayer layer, bool inside) const { return plans[inside][static_cast<int>(layer)]; }
};

// The memory of a material's ready lobes.
struct ReadyLobes {
  std::vector<ReadyLobe> lobes;
  std::vector<std::unique_ptr<const CachedPlan>> plans; // of the lobes

  const ReadyLobe &operator[](size_t number) const { return lobes[number]; }
};

#define LANCER_NAME(kind, name, spoken, given) name,
enum class PrincipledParameter { LANCER_PRINCIPLED_PARAMETERS(LANCER_NAME) };
#undef LANCER_NAME

// Whether a parameter has to be read for a lobe of these parts: an absent layer needs none of its parameters, and the
// parameters of planned facets are in the plan.
LANCER_LANE constexpr bool needed(PrincipledParameter parameter, const LobeParts &parts, bool planned) {
  using P = PrincipledParameter;
  switch (parameter) {
  case P::metallic:
    return parts.metal;
  case P::transmission:
    return parts.glass;
  case P::coat:
    return parts.coat;
  case P::coat_tint:
    return parts.coat_tint;
  case P::coat_normal:
    return parts.coat_normal;
  case P::diffuse_roughness:
    return parts.diffuse_roughness;
  case P::emission:
    return parts.emission;
  case P::sheen:
  case P::sheen_roughness:
  case P::sheen_tint:
    return parts.sheen;
  case P::film_thickness:
  case P::film_ior:
    return parts.film && !planned;
  case P::subsurface:
  case P::subsurface_radius:
  case P::subsurface_color:
  case P::subsurface_ior:
  case P::subsurface_anisotropy:
    return parts.below;
  case P::thin_wall:
  case P::wall_scattering:
  case P::wall_forward:
    return parts.sheet;
  case P::roughness:
  case P::ior:
  case P::specular:
  case P::specular_tint:
  case P::anisotropic:
  case P::anisotropic_rotation:
  case P::transmission_roughness:
  case P::coat_roughness:
  case P::coat_ior:
    return !planned;
  default:
    return true;
  }
}

// A lobe for each lane, all with the same code.
template <class F> struct LaneLobes : LaneRecords<F, ReadyLobe> {
  using LaneRecords<F, ReadyLobe>::of, LaneRecords<F, ReadyLobe>::same;
  using LaneRecords<F, ReadyLobe>::number, LaneRecords<F, ReadyLobe>::vector;

  uint32_t inside = 0; // bits of lanes

  // Returns the inputs of lobes without nodes.
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
    if (of[0]->parts.across) {
      in.roughness_across = number(LANCER_OF(inputs.roughness_across));
      in.offset = number(LANCER_OF(inputs.offset));
    }
    if (of[0]->parts.film) {
      in.film_thickness = number(LANCER_OF(inputs.film_thickness));
      in.film_ior = number(LANCER_OF(inputs.film_ior));
    }
    return in;
  }
  // Returns the inputs that all layers of Principled share, without those that principled() reads.
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
    in.subsurface_option = first.principled.subsurface_option;
    // The inputs of facets are contained in their plans, where plans are kept.
    const bool planned = in.rules != Rules::Blender3 && first.has(PrincipledLayer::Gloss) &&
                         (!parts.coat || first.has(PrincipledLayer::Coat)) && !parts.tangent && !parts.sheet && !parts.below;
#define LANCER_READ(kind, name, spoken, given)                                                                                 \
  if (needed(PrincipledParameter::name, parts, planned))                                                                       \
    in.name = value<ParameterKind::kind>(LANCER_OF(principled.name));
    LANCER_PRINCIPLED_PARAMETERS(LANCER_READ)
#undef LANCER_READ
    return in;
  }
#undef LANCER_OF
  // get: returns a parameter of that kind.
  template <ParameterKind kind, class Get> LANCER_LANE ValueOf<F, kind> value(const Get &get) const {
    if constexpr (std::is_same_v<ValueOf<F, kind>, F>)
      return number(get);
    else
      return vector(get);
  }

  // The layers with a plan, as add_layers() reads them.
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

// Adds the lobes of one described lobe. number: of the described lobe among the material's. values: returns a parameter's value
// in every lane. hole: lanes whose lobes a holdout hides.
template <class F, class Values>
void add_described(const MaterialView *const *materials, size_t number, const Values &values, MaskOf<F> hole, Bsdf<F> &bsdf) {
  const LobeDescription &described = materials[0]->lobes[number];
  LaneLobes<F> ready;
  ready.inside = bits(bsdf.inside);
  for (int i = 1; i < LanesOf<F>::kWidth; ++i)
    ready.same = ready.same && materials[i] == materials[0];
  ready.of[0] = &materials[0]->ready[number];
  for (int i = 1; i < LanesOf<F>::kWidth && !ready.same; ++i)
    ready.of[i] = &materials[i]->ready[number];
  const bool fixed = materials[0]->fixed(), any_hole = any(hole);
  const ParameterReader<F, const Values &> read{values};
  const auto without_holes = [&](LobeInputs<F> inputs) __attribute__((always_inline)) {
    if (any_hole)
      inputs.weight = select(hole, Vec3<F>(F(0.0f)), inputs.weight);
    return inputs;
  };
  if (!described.principled) {
    const LobeInputs<F> inputs = without_holes(fixed ? ready.inputs() : evaluate(described, read));
    if (any(!black(inputs.weight)))
      add_cached(bsdf, inputs, ready);
    return;
  }
  const LobeInputs<F> inputs = without_holes(fixed ? ready.principled_carrier() : evaluate(described, read));
  if (any(!black(inputs.weight)))
    add_principled(bsdf, inputs, fixed ? ready.principled() : evaluate(*described.principled, read), ready);
}

// The paths whose hits ask for lobes: the members of the same names of Bsdf. leaving: all of them come from below the surface;
// dimmed: those whose exit Fresnel's weight dims.
template <class F> struct AskingPaths {
  MaskOf<F> seen_by_camera = uniform<F>(true), ends = uniform<F>(false), after_diffuse = uniform<F>(false);
  bool walks = false, leaving = false;
  MaskOf<F> dimmed = uniform<F>(false);
  F pixel{0.0f};
  WordOf<F> key{0u};
  LobeLimits<F> limits{};
};

// Adds all lobes of the material as seen from wo. out_ns, out_ng: of the surface, outwards.
template <class F, class Values>
LANCER_LANE void find_lobes(const MaterialView *const *materials, const Values &values, MaskOf<F> hole, const Vec3<F> &wo,
                            const Vec3<F> &out_ns, const Vec3<F> &out_ng, Bsdf<F> &bsdf, const AskingPaths<F> &paths = {}) {
  const MaterialView &material = *materials[0];
  // Turn both normals to the viewer's side.
  const MaskOf<F> inside = dot(wo, out_ng) < F(0.0f);
  Vec3<F> ns = select(inside, -out_ns, out_ns);
  const Vec3<F> ng = select(inside, -out_ng, out_ng);
  const bool finds_lobes = !paths.leaving || material.bends_exits;
  // A bump of the whole surface replaces its normal; nodes return it on the viewer's side.
  if (finds_lobes && material.normal.varies())
    ns = unit_or(Vec3<F>(values(material.normal)), ns);
  bsdf.begin(wo, ns, ng, inside, !(material.flags & MaterialFlag::NoBumpCorrection));
  bsdf.seen_by_camera = paths.seen_by_camera;
  bsdf.ends = paths.ends;
  bsdf.walks = paths.walks;
  bsdf.after_diffuse = paths.after_diffuse;
  bsdf.pixel = paths.pixel;
  bsdf.key = paths.key;
  bsdf.limits_caustics = paths.limits.caustics;
  bsdf.no_reflections = paths.limits.no_reflections;
  for (size_t i = 0; i < material.lobes.size() && finds_lobes; ++i)
    add_described<F>(materials, i, values, hole, bsdf);
  if (paths.leaving)
    leave_below(bsdf, material.lobes.empty() ? Rules::Blender45 : material.lobes.front().rules, paths.dimmed);
  if (paths.limits.any())
    limit_lobes(bsdf, paths.limits);
  bsdf.complete();
}

} // namespace lancer
