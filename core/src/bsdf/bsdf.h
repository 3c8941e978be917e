// A surface's whole answer at one place: a sum of lobes with one way to evaluate it and one to sample it.
#pragma once

#include "bsdf/frame.h"
#include "bsdf/lobe.h"

namespace lancer {

// Light scattered from wi towards wo, by component: f |cos(wi)|, and the density with which sample() would have taken wi.
struct BsdfValue {
  glm::vec3 part[3] = {glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)}; // by Component
  float pdf = 0.0f;

  glm::vec3 f() const { return part[0] + part[1] + part[2]; }
};

// weight 0 = no sample: the path ends there.
struct BsdfSample {
  glm::vec3 wi{0.0f};     // world, unit
  glm::vec3 weight{0.0f}; // f |cos(wi)| / pdf over all smooth lobes, or the single direction's weight over its probability
  glm::vec3 share[2] = {glm::vec3(0.0f), glm::vec3(0.0f)}; // of weight that is diffuse, glossy; the rest is transmission
  float pdf = 0.0f;                         // per solid angle; for a single direction the probability of having chosen it
  bool delta = false;                       // a single direction: evaluation and pdf elsewhere are 0
  Component component = Component::Diffuse; // of the chosen lobe
  bool transmitted = false;                 // it goes through the surface
  float alpha2 = 1.0f;                      // alpha_x alpha_y of the chosen lobe; 0 for a single direction
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
//   Shapes    bits shape_bit(...) of the shapes that can occur; the code of others is left out, the results are the same.
struct Bsdf {
  glm::vec3 wo{0, 0, 1}, ns{0, 0, 1}, ng{0, 0, 1};
  bool inside = false;
  bool bump_correction = true;
  bool flat = true;       // ns is ng
  bool smooth = false;    // some lobe is more than single directions; set by complete()
  bool transmits = false; // some lobe lets light through; set by complete()
  bool shares = true;     // samples say their shares by component
  uint32_t shapes = 0;    // shape_bit of the lobes that are there
  int frame_count = 0;
  int count = 0;
  glm::vec3 emission{0.0f}; // what layered lobes emit towards wo
  // Neither is initialised: only the first frame_count and count entries exist.
  union {
    Frame frames[kMaxFrames];
  };
  glm::vec3 wo_local[kMaxFrames]; // wo in each of the frames
  union {
    Lobe lobes[kMaxLobes];
  };

  Bsdf() {}

  void begin(const glm::vec3 &wo, const glm::vec3 &ns, const glm::vec3 &ng, bool inside, bool bump_correction);
  void complete();

  // drawn: the lobe that drew wi, as sample() weighs it; -1: none.
  template <uint32_t Shapes = kAllShapes> BsdfValue eval(const glm::vec3 &wi, int drawn = -1) const;
  // For light samples.
  template <uint32_t Shapes = kAllShapes> BsdfValue eval_lit(const glm::vec3 &wi) const;
  // u_lobe picks the lobe, and what it says beyond that picks reflection or refraction; u the direction; all in [0, 1).
  template <uint32_t Shapes = kAllShapes> BsdfSample sample(float u_lobe, glm::vec2 u) const;

  // Sum of the lobes' albedos.
  glm::vec3 albedo() const;
  // What the passes call the colour of a component: the albedo, except for lobes that Cycles 3 shows without Fresnel.
  glm::vec3 shown(Component component) const;

private:
  // Directions of one wi in all frames.
  struct Local {
    glm::vec3 wi[kMaxFrames];
    float cos_ng; // to ng
  };
  // The lobe that drew wi, with the half vector that its sampler had, if it had one.
  struct Drawn {
    int lobe = -1;
    bool has_h = false;
    glm::vec3 h{0.0f};
  };

  template <uint32_t Shapes> static bool is(const Lobe &lobe, LobeShape shape);
  template <uint32_t Shapes> static bool is_delta(const Lobe &lobe);
  template <uint32_t Shapes> BsdfValue sum(const Local &local, const Drawn &drawn, bool lit) const;
  template <uint32_t Shapes> BsdfSample sample_delta(const Lobe &lobe, float u) const;
  template <uint32_t Shapes> BsdfSample sample_smooth(int chosen, float u_side, glm::vec2 u) const;
  BsdfSample single(const Lobe &lobe, const glm::vec3 &wi, const glm::vec3 &weight, float probability) const;
  void turn_to_frames(const glm::vec3 &wi, int known, const glm::vec3 &wi_known, Local &local) const;
  int pick(float &u) const;
};

} // namespace lancer

#include "bsdf/bsdf_terms.h" // the templates
