// Builds the lobes of a shading point from a material and the values of its nodes. F is a float, or lanes of floats whose
// materials are of one class.
#pragma once

#include "bsdf/principled.h"
#include "bsdf/ready_lobe.h"
#include "scene/material.h"

namespace lancer {

// Adds the lobes of one described lobe. number: of the described lobe among the material's. values: returns a parameter's value
// in every lane. hole: lanes where the surface is absent.
template <class F, class Values>
void add_described(const Material *const *materials, size_t number, const Values &values, MaskOf<F> hole, Bsdf<F> &bsdf) {
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

// Adds all lobes of the material as seen from wo. out_ns, out_ng: of the surface, outwards.
template <class F, class Values>
LANCER_LANE void find_lobes(const Material *const *materials, const Values &values, MaskOf<F> hole, const Vec3<F> &wo,
                            const Vec3<F> &out_ns, const Vec3<F> &out_ng, Bsdf<F> &bsdf) {
  const Material &material = *materials[0];
  // Turn both normals to the viewer's side.
  const MaskOf<F> inside = dot(wo, out_ng) < F(0.0f);
  Vec3<F> ns = select(inside, -out_ns, out_ns);
  const Vec3<F> ng = select(inside, -out_ng, out_ng);
  // A bump of the whole surface replaces its normal; nodes return it on the viewer's side.
  if (material.normal.varies())
    ns = unit_or(Vec3<F>(values(material.normal)), ns);
  bsdf.begin(wo, ns, ng, inside, !(material.flags & MaterialFlag::NoBumpCorrection));
  for (size_t i = 0; i < material.lobes.size(); ++i)
    add_described<F>(materials, i, values, hole, bsdf);
  bsdf.complete();
}

} // namespace lancer
