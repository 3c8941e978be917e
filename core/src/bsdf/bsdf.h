// The BSDF of a surface at a hit: a sum of lobes with one evaluation and one sampling routine.
#pragma once

#include "bsdf/lobe.h"

namespace lancer {

// Light scattered from wi towards wo, by component: f |cos(wi)|, and the density with which sample() samples wi.
template <class F> struct BsdfValue {
  using V = Vec3<F>;
  V part[3] = {V(F(0.0f)), V(F(0.0f)), V(F(0.0f))}; // by Component
  F pdf{0.0f};
  F alpha2{0.0f}; // sum of the lobes' densities times their alpha_x alpha_y, where Bsdf::spreads is set

  LANCER_LANE V f() const { return part[0] + part[1] + part[2]; }
};

// weight 0 means no sample: the path ends.
template <class F> struct BsdfSample {
  using V = Vec3<F>;
  V wi{F(0.0f)};     // world, unit
  V weight{F(0.0f)}; // f |cos(wi)| / pdf over all smooth lobes, or the weight of a single direction over its probability
  V share[2] = {V(F(0.0f)), V(F(0.0f))};     // diffuse and glossy shares of weight; the rest is transmission
  F pdf{0.0f};                               // per solid angle; for a single direction its probability
  MaskOf<F> delta = uniform<F>(false);       // a single direction: evaluation and pdf elsewhere are 0
  MaskOf<F> transmitted = uniform<F>(false); // wi passes through the surface
  WordOf<F> component{0u};                   // Component of the sampled lobe
  MaskOf<F> diffuse = uniform<F>(false);     // the ray is a diffuse one: also of velvet, whose light is glossy
  F alpha2{1.0f};                            // alpha_x alpha_y of the sampled lobe; 0 for a single direction
  F mean_alpha2{0.0f}; // of all lobes by their densities for wi, where Bsdf::spreads is set; 0 for a single direction
  // Light enters the surface along wi, which is a single direction, to walk below it; the following describe the walk.
  MaskOf<F> entered = uniform<F>(false);
  V below_color{F(0.0f)}, below_radius{F(0.0f)}; // radius in the user's units
  F below_g{0.0f}, below_ior{1.4f};
  WordOf<F> below_variant{0u}; // Lobe::variant
};

// Contract
//   Place     begin() sets wo: unit, away from the surface; ng: unit, on the side of wo; ns: unit, flipped together with ng.
//             Where a mesh's normals oppose their face, ns points below the surface, and the result is that of Cycles. inside:
//             wo is behind the outward side. All directions are in world space.
//   Lobes     add_lobe and add_principled (build.h) add lobes; complete() computes their probabilities. A lobe may have its own
//             normal. It reflects on the side of its normal and transmits to the other; lobes that need wo on this side are 0
//             if wo is behind their normal.
//   eval      f |cos| of smooth lobes, with the cosine to the lobe's own normal; single directions are 0.
//   eval_lit  f |cos| for light samples as Cycles weights them: rough boundaries also transmit between directions on one side
//             of their half vector. No facet connects such directions, so the lobe's own sampler never samples them, and the
//             result depends on the density of the other technique, as in Cycles. sample() also weights with this value if
//             another lobe samples such a direction. The pdf of eval_lit includes directions that cross the surface to the
//             wrong side of ng.
//   pdf       per solid angle; the pdf of eval integrates to 1 minus the probability of single directions minus the loss at
//             the horizon. That of Huang's fibre is 1 everywhere, as in Cycles: its samples carry a value of their own, and its
//             value is an estimate, the same for the same key and directions.
//   Sides     A lobe decides by its own normal whether wi is reflected or transmitted. Two other normals matter:
//             - ns, if the lobe's normal differs from ns (bump): the value is 0 if wi is on one side of ns and on the other
//               side of the lobe's normal. Diffuse lobes fall off smoothly towards that limit if bump_correction is set.
//               Reflecting and transmitting lobes keep their own samples beyond ns, as in Cycles.
//             - ng: sample() samples no direction to the wrong side of ng, so the pdf is 0 there, except for refracting lobes
//               by the rules of Blender 3, as in Cycles 3. The value is not 0 there: lights illuminate the smooth surface that
//               interpolated normals describe, and the shadow ray finds occluders.
//   Lanes     F is float or lanes of it: every lane is a hit of its own, with lobes of the same code. In a lane where a lobe is
//             black, the lobe is absent.
template <class F> struct Bsdf {
  using V = Vec3<F>;
  using B = MaskOf<F>;

  V wo{F(0.0f), F(0.0f), F(1.0f)}, ns{F(0.0f), F(0.0f), F(1.0f)}, ng{F(0.0f), F(0.0f), F(1.0f)};
  B inside = uniform<F>(false);
  B flat = uniform<F>(true);       // ns is ng
  B smooth = uniform<F>(false);    // some lobe has more than single directions; set by complete()
  B transmits = uniform<F>(false); // some lobe transmits; set by complete()
  bool bump_correction = true;
  bool shares = true;   // samples carry their shares by component
  bool spreads = false; // samples carry the mean roughness of their direction
  WordOf<F> key{0u};    // of the numbers of Huang's fibre, whose value is an estimate by numbers of its own
  int frame_count = 0;
  int count = 0;
  V emission{F(0.0f)}; // emission of layered lobes towards wo
  // A smooth sheet scatters rays of the camera; other rays pass it straight: their share is no lobe.
  B seen_by_camera = uniform<F>(true);
  V straight{F(0.0f)};
  // Paths that only ask for the emission; as in Cycles, no layer above dims it then.
  B ends = uniform<F>(false);
  // Walks below the surface: whether the integrator sends any; paths that a diffuse lobe has scattered before; and the width of
  // a pixel there, in the user's units.
  bool walks = false;
  B after_diffuse = uniform<F>(false);
  F pixel{0.0f};
  // Lanes whose paths meet no lobes that mirror; read only where the integrator limits caustics.
  bool limits_caustics = false;
  B no_reflections = uniform<F>(false);
  // Uninitialised: only the first frame_count and count entries exist.
  union {
    Frame<F> frames[kMaxFrames];
  };
  union {
    V wo_local[kMaxFrames]; // wo in each of the frames
  };
  // The number of the first equal frame in each lane, possibly of the frame itself.
  union {
    WordOf<F> first_same[kMaxFrames];
  };
  union {
    Lobe<F> lobes[kMaxLobes];
  };

  Bsdf() {}

  void begin(const V &wo, const V &ns, const V &ng, B inside, bool bump_correction);
  void complete();
  // Adds a lobe unless it is black or the array is full.
  void add(const Lobe<F> &lobe);

  // drawn: the lobe that sampled wi, for the weights of sample(); -1 if wi is not a sample.
  BsdfValue<F> eval(const V &wi, int drawn = -1) const;
  // Evaluates light samples. shapes: bits of the lobes to evaluate. hidden: lanes whose light shows no lobes of a class, by
  // Component; null: none.
  BsdfValue<F> eval_lit(const V &wi, uint32_t shapes = kAllShapes, const B *hidden = nullptr) const;
  // u_lobe selects the lobe, and its remainder selects reflection or refraction; u and v select the direction; all in [0, 1).
  BsdfSample<F> sample(F u_lobe, F u, F v) const;

  // Returns the sum of the lobes' albedos.
  V albedo() const;
  // Returns the colour of a component for the passes: the albedo, except for lobes that Cycles 3 shows without Fresnel.
  V shown(Component component) const;

private:
  // Local directions of one wi in all frames.
  struct Local {
    V wi[kMaxFrames];
    F cos_ng; // cosine to ng
  };
  // The lobe that sampled wi in each lane, with its sampler's half vector, or with the value of Huang's sample, if any.
  struct Drawn {
    WordOf<F> lobe, frame;
    B has_h = uniform<F>(false);
    V h;
    B has_value = uniform<F>(false);
    V value{F(0.0f)};
  };
  struct Direction;

  void turn_to_frames(const V &wi, const WordOf<F> &known, const V &wi_known, B single, Local &local) const;
  ColorValue<F> fibre_value(const Lobe<F> &lobe, const V &wi, const B &drew, const Drawn &drawn) const;
  ColorValue<F> smooth_value(const Lobe<F> &lobe, const V &wi, const V &h) const;
  BsdfValue<F> sum(const Local &local, const Drawn &drawn, bool lit, uint32_t shapes = kAllShapes,
                   const B *hidden = nullptr) const;
  void draw(const Lobe<F> &lobe, B mine, F u_side, F u, F v, Direction &direction) const;
};

} // namespace lancer

#include "bsdf/bsdf_sample.h" // the templates
