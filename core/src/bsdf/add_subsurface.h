// Light below a surface as a lobe of a hit, and the white surface by which it leaves.
#pragma once

#include "bsdf/bsdf.h"
#include "bsdf/matte.h"
#include "bsdf/normals.h"
#include "bsdf/subsurface_lobe.h"

namespace lancer {

// Adds the channels that light enters by. Returns the weight of the others, which leave where they enter: all if the integrator
// walks nowhere, those of a small radius, and after a diffuse scattering those of Burley's profile, before 5.0 of every method.
template <class F> LANCER_LANE Vec3<F> add_subsurface(Bsdf<F> &bsdf, uint8_t frame, SubsurfaceInputs<F> in) {
  using V = Vec3<F>;
  if (!bsdf.walks)
    return in.weight;
  const bool burley = (in.option & kMethodBits) == static_cast<uint32_t>(SubsurfaceMethod::Burley);
  const F zero(0.0f);
  const F least = in.option & kQuarterPixel ? max(F(0.25f) * bsdf.pixel, F(kSmallestRadius)) : F(kSmallestRadius);
  const MaskOf<F> walks = uniform<F>(in.rules >= Rules::Blender50 && !burley) | !bsdf.after_diffuse;
  const auto deep = [&](F radius, F value) { return select(walks & (radius >= least), value, zero); };
  const V entering{deep(in.radius.x, in.weight.x), deep(in.radius.y, in.weight.y), deep(in.radius.z, in.weight.z)};
  const V matt = in.weight - entering;
  in.radius = {deep(in.radius.x, in.radius.x), deep(in.radius.y, in.radius.y), deep(in.radius.z, in.radius.z)};
  in.weight = entering;
  bsdf.add(make_subsurface(in, frame));
  return matt;
}

// Returns the lanes in which light may enter.
template <class F> LANCER_LANE MaskOf<F> enters(const Bsdf<F> &bsdf) {
  MaskOf<F> there = uniform<F>(false);
  for (int i = 0; i < bsdf.count; ++i)
    if (is_subsurface(bsdf.lobes[i]))
      there = there | (bsdf.lobes[i].probability > F(0.0f));
  return there;
}

// Replaces all lobes by a white diffuse one, about the mean normal of the subsurface lobes. rules: of the material; dimmed: by
// Burley's Fresnel weight.
template <class F> void leave_below(Bsdf<F> &bsdf, Rules rules, MaskOf<F> dimmed) {
  using V = Vec3<F>;
  V n(F(0.0f));
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe<F> &lobe = bsdf.lobes[i];
    if (!is_subsurface(lobe))
      continue;
    n += abs(mean(lobe.color)) * bsdf.frames[lobe.frame].n;
  }
  bsdf.count = 0;
  bsdf.frame_count = 1;
  bsdf.emission = bsdf.straight = V(F(0.0f));
  const uint8_t frame = add_frame(bsdf, unit_or(n, bsdf.ns));
  Lobe<F> exit = make_lambert<F>(V(F(1.0f)), frame, rules);
  if (any(dimmed)) {
    exit.shape = LobeShape::Matte;
    exit.variant = static_cast<uint8_t>(Matte::BurleyExit);
    exit.alpha_x = select(dimmed, F(0.5f), F(0.0f));
  }
  bsdf.add(exit);
}

} // namespace lancer
