// A sheet of glass or of dense matter, thinner than any path within it: Principled with thin walls, from Blender 5.2 on.
// Included by principled.h only.
#pragma once

#include "bsdf/build.h"

namespace lancer {

// The light that a sheet of glass returns and lets through, all reflections between its sides included.
template <class F> struct SheetShares { Vec3<F> reflected, through; };

// front: the facets of one side, as seen from outside; tint: transmittance of the sheet along its normal.
template <class F> LANCER_LANE SheetShares<F> sheet_shares(const Lobe<F> &front, F cos_o, const Vec3<F> &tint) {
  using V = Vec3<F>;
  const V one(F(1.0f)), none(F(0.0f));
  const FacetResponse<F> entering = facet_response(front, cos_o);
  V r = entering.reflected, t = entering.through;
  if (front.film) {
    // From inside, the film lies beyond the glass; scaled by the index of the glass, it is as seen from air.
    Lobe<F> back = front;
    const ThinFilm<F> film = film_of(front);
    set_curve(back, 1.0f / front.ior);
    set_film(back, film.thickness, film.ior / front.ior);
    const FacetResponse<F> leaving = facet_response(back, entering.cos_t);
    const MaskOf<F> there = film.thickness > kThinnestFilm;
    r = select(there, leaving.reflected, r);
    t = select(there, leaving.through, t);
  }
  // Light within the sheet is absorbed by Beer's law over the way between its sides.
  const MaskOf<F> enters = entering.cos_t > 0.0f;
  const F depth = 1.0f / select(enters, entering.cos_t, F(1.0f));
  const V clear = select(enters, V(pow(tint.x, depth), pow(tint.y, depth), pow(tint.z, depth)), none);
  const V back = r * clear, closed = one - back * back;
  const V all = clear * entering.through * t;
  const V through(quotient(all.x, closed.x), quotient(all.y, closed.y), quotient(all.z, closed.z));
  return {entering.reflected + through * back, through};
}

// Returns alpha of the light through a sheet, which is refracted twice (Kulla and Conty 2017).
template <class F> LANCER_LANE F sheet_alpha(F alpha, F ior) {
  const F e = 1.0f / ior, middle = 1.0f - 0.5f * e, wider = 3.4f * (1.0f - e) * middle * middle;
  return clamp01(alpha * sqrt(max(wider, F(0.0f))));
}

// front: the facets of the sheet without a weight, of its frame.
template <class F>
void add_glass_sheet(Bsdf<F> &bsdf, const Lobe<F> &front, const Vec3<F> &weight, const PrincipledInputs<F> &in, F cos_o) {
  using V = Vec3<F>;
  const V none(F(0.0f));
  const SheetShares<F> shares = sheet_shares(front, cos_o, clamp01(max(in.base_color, none)));
  const MaskOf<F> preserving = uniform<F>(true);
  Lobe<F> reflection =
      make_microfacet(Scatter::Reflect, front.frame, weight * shares.reflected, front.alpha_x, front.alpha_x, in.rules);
  set_constant(reflection, max(in.specular_tint, none));
  complete_microfacet(reflection, cos_o, preserving);
  bsdf.add(reflection);

  const F alpha = sheet_alpha(front.alpha_x, front.ior);
  Lobe<F> through = make_microfacet(Scatter::Through, front.frame, weight * shares.through, alpha, alpha, in.rules);
  complete_microfacet(through, cos_o, preserving);
  const MaskOf<F> passes = through.delta & !bsdf.seen_by_camera;
  if (any(passes)) {
    bsdf.straight = select(passes, bsdf.straight + through.color, bsdf.straight);
    through.color = select(passes, none, through.color);
  }
  bsdf.add(through);
}

// Adds both sides of a sheet of dense matter. weight: of all of its light, colour included.
template <class F>
void add_matt_sheet(Bsdf<F> &bsdf, uint8_t frame, const Vec3<F> &weight, const Vec3<F> &color, const PrincipledInputs<F> &in,
                    F cos_o) {
  const F forward = clamp01(in.wall_forward);
  for (const bool beyond : {false, true}) {
    Lobe<F> side =
        make_diffuse(weight * (beyond ? forward : 1.0f - forward), color, clamp01(in.diffuse_roughness), in.option == 1, cos_o);
    if (beyond) {
      const bool rough = side.shape == LobeShape::Matte;
      side.shape = LobeShape::Matte;
      side.variant = static_cast<uint8_t>(rough ? Matte::RoughTranslucent : Matte::Translucent);
    }
    side.frame = frame;
    side.rules = in.rules;
    bsdf.add(side);
  }
}

} // namespace lancer
