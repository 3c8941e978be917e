// From inputs to lobes: which lobes a described one becomes at this place, with which weights.
#pragma once

#include "bsdf/bsdf.h"
#include "bsdf/inputs.h"

namespace lancer {

// The bits of the shapes that a kind can become.
uint32_t shapes_of(LobeKind kind);

// Both add to a BSDF between begin() and complete(); black lobes are left out, and what finds no room any more is dropped.
void add_lobe(Bsdf &bsdf, const LobeInputs &inputs);
// lobe carries weight, normal and tangent.
void add_principled(Bsdf &bsdf, const LobeInputs &lobe, const PrincipledInputs &principled);

// The number of a frame about the normal n with tangent t (0 = any); the shading frame where both are 0. Where room is out, the
// shading frame.
uint8_t add_frame(Bsdf &bsdf, const glm::vec3 &n, const glm::vec3 &t);

// A unit normal for lobes that reflect: n (0 = the shading normal) if what it mirrors from wo stays above the surface, else
// turned towards ng just far enough. As it is where the material wants no bump correction.
glm::vec3 reflecting_normal(const Bsdf &bsdf, const glm::vec3 &n);
// n itself or, where it is 0, the shading normal.
glm::vec3 normal_or_shading(const Bsdf &bsdf, const glm::vec3 &n);

// t turned about the unit axis by turns, counter-clockwise seen from its tip.
glm::vec3 turn_about(const glm::vec3 &t, const glm::vec3 &axis, float turns);

} // namespace lancer
