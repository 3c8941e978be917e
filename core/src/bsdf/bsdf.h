// A surface's whole answer at one place: a sum of lobes with one way to evaluate it and one to sample it.
#pragma once

#include "bsdf/frame.h"
#include "bsdf/lobe.h"

namespace lancer {

// Light scattered from wi towards wo, by component: f |cos(wi)|, and the density with which sample() would have taken wi.
template <class F> struct BsdfValue {
  using V = Vec3<F>;
  V part[3] = {V(F(0.0f)), V(F(0.0f)), V(F(0.0f))}; // by Component
  F pdf{0.0f};

  LANCER_LANE V f() const { return part[0] + part[1] + part[2]; }
};

// weight 0 = no sample: the path ends there.
template <class F> struct BsdfSample {
  using V = Vec3<F>;
  V wi{F(0.0f)};     // world, unit
  V weight{F(0.0f)}; // f |cos(wi)| / pdf over all smooth lobes, or the single direction's weight over its probability
  V share[2] = {V(F(0.0f)), V(F(0.0f))};     // of weight that is diffuse, glossy; the rest is transmission
  F pdf{0.0f};                               // per solid angle; for a single direction the probability of having chosen it
  MaskOf<F> delta = uniform<F>(false);       // a single direction: evaluation and pdf elsewhere are 0
  MaskOf<F> transmitted = uniform<F>(false); // it goes through the surface
  WordOf<F> component{0u};                   // Component of the chosen lobe
  F alpha2{1.0f};                            // alpha_x alpha_y of the chosen lobe; 0 for a single direction
};

// Contract
//   Place     begin() says where: wo unit, away from the surface; ng unit, on the side of wo; ns unit, turned over as ng was:
//             beyond the surface where the mesh's normals look away from their face, and there it lights as Cycles has it;
//             inside: wo lies behind the outward side. All directions are in the world.
//   Lobes     are added by add_lobe and add_principled (build.h); complete() makes the probabilities. A lobe's normal may be
//             its own. It acts on the side of its normal and scatters through to the other; lobes that need wo there are 0
//             where wo is behind their normal.
//   eval      f |cos| of smooth lobes, single directions are 0; the cosine is that of the lobe's own normal.
//   eval_lit  the same as samples of lights are weighed, as in Cycles: rough boundaries also pass light between directions
//             that lie on one side of their half vector. No facet does that: their own sampler never draws it, so that what
//             it shows depends on the other technique's density, here as there. sample() weighs with it, too, where another
//             lobe draws such a direction. Its pdf also counts directions that pass the surface the wrong way by ng.
//   pdf       per solid angle; that of eval integrates to 1 minus the probability of single directions minus what is lost at
//             the horizon.
//   Sides     A lobe decides by its own normal whether wi is reflected or goes through. Two other normals have a say:
//             - ns, where the lobe's normal differs from it (bump): a direction on the other side of ns than the lobe says
//               is 0, and diffuse lobes end smoothly before it where bump_correction is set.
//               A lobe that reflects, and one that lets through, keep what they draw themselves beyond ns, as in Cycles.
//             - ng: sample() never takes a direction that would pass the surface the wrong way, so its pdf is 0; of lobes that
//               refract by the rules of Blender 3 it does, as Cycles 3. The value stays: lights are met as on the smooth
//               surface that interpolated normals stand for, and what is in the way of the shadow ray decides.
//   Lanes     F is float, or lanes of it: every lane is a place of its own, with lobes of the same code. A lobe that is black
//   in a
//             lane is not there in it.
template <class F> struct Bsdf {
  using V = Vec3<F>;
  using B = MaskOf<F>;

  V wo{F(0.0f), F(0.0f), F(1.0f)}, ns{F(0.0f), F(0.0f), F(1.0f)}, ng{F(0.0f), F(0.0f), F(1.0f)};
  B inside = uniform<F>(false);
  B flat = uniform<F>(true);       // ns is ng
  B smooth = uniform<F>(false);    // some lobe is more than single directions; set by complete()
  B transmits = uniform<F>(false); // some lobe lets light through; set by complete()
  bool bump_correction = true;
  bool shares = true; // samples say their shares by component
  int frame_count = 0;
  int count = 0;
  V emission{F(0.0f)}; // what layered lobes emit towards wo
  // Neither is initialised: only the first frame_count and count entries exist.
  union {
    Frame<F> frames[kMaxFrames];
  };
  union {
    V wo_local[kMaxFrames]; // wo in each of the frames
  };
  // The first frame that is the same in a lane: its number, or its own.
  union {
    WordOf<F> first_same[kMaxFrames];
  };
  union {
    Lobe<F> lobes[kMaxLobes];
  };

  Bsdf() {}

  void begin(const V &wo, const V &ns, const V &ng, B inside, bool bump_correction);
  void complete();
  // Adds a lobe unless it is black or no room is left.
  void add(const Lobe<F> &lobe);

  // drawn: the lobe that drew wi, as sample() weighs it; -1: none.
  BsdfValue<F> eval(const V &wi, int drawn = -1) const;
  // For light samples. shapes: bits of the lobes that are asked.
  BsdfValue<F> eval_lit(const V &wi, uint32_t shapes = kAllShapes) const;
  // u_lobe picks the lobe, and what it says beyond that picks reflection or refraction; u and v the direction; all in [0, 1).
  BsdfSample<F> sample(F u_lobe, F u, F v) const;

  // Sum of the lobes' albedos.
  V albedo() const;
  // What the passes call the colour of a component: the albedo, except for lobes that Cycles 3 shows without Fresnel.
  V shown(Component component) const;

private:
  // Directions of one wi in all frames.
  struct Local {
    V wi[kMaxFrames];
    F cos_ng; // to ng
  };
  // The lobe that drew wi in each lane, with the half vector that its sampler had, if it had one.
  struct Drawn {
    WordOf<F> lobe, frame;
    B has_h;
    V h;
  };
  struct Direction;

  void turn_to_frames(const V &wi, const WordOf<F> &known, const V &wi_known, B single, Local &local) const;
  ColorValue<F> smooth_value(const Lobe<F> &lobe, const V &wi, const V &h) const;
  BsdfValue<F> sum(const Local &local, const Drawn &drawn, bool lit, uint32_t shapes = kAllShapes) const;
  void draw(const Lobe<F> &lobe, B mine, F u_side, F u, F v, Direction &direction) const;
};

} // namespace lancer

#include "bsdf/bsdf_sample.h" // the templates
