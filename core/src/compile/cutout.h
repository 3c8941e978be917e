// Surfaces that pictures cut out, as leaves and fences are made.
#pragma once

#include "scene/material.h"
#include "scene/node.h"

#include <optional>

namespace lancer {

// Pictures that lie flat on a mesh by its UV map, and the nodes that let their alpha decide how much of a surface is there.
struct FlatImage {
  uint32_t image = kNone;
  uint32_t uv_map = 0; // number of the name
  Extension extension = Extension::Repeat;
  Interpolation interpolation = Interpolation::Linear;

  bool known() const { return image != kNone; }
};

// The picture that a colour is; not known where it is anything else.
FlatImage flat_image(const Program &program, const Parameter &color, const std::vector<Image> &images);

// The alpha of a picture, as it is or as a mix of shaders takes it for its factor: clamped to 0 ... 1.
struct ImageAlpha {
  Parameter picture; // its colour
  bool clamped = false;
};
// Nothing where the value is anything else.
std::optional<ImageAlpha> image_alpha(const Program &program, const Parameter &value);

inline float clamped_alpha(float alpha, bool clamped) { return clamped ? glm::clamp(alpha, 0.0f, 1.0f) : alpha; }

// A constant less what nodes say, as surfaces that are there in part let light pass.
struct Remainder {
  float whole = 1.0f;
  Parameter share;
};
// Nothing where the value is anything else.
std::optional<Remainder> remainder_of(const Program &program, const Parameter &value);

// Surfaces that pictures cut out, as leaves and fences are made: their transmittance is known without
// shading them.

// The alpha of one picture.
struct AlphaImage : FlatImage {
  bool clamped = false; // to 0 ... 1
};

struct Cutout {
  AlphaImage alpha;             // known: the transmittance is 1 - alpha
  bool painted = false;         // what passes depends on the place within a triangle alone
  bool may_end = false;         // there may be nothing of the surface at some places: see Shader::is_there()
  bool ends_with_alpha = false; // and that is where alpha is 0
  Schedule nodes;               // of transmittance and the lobes' weights
};

// By number of material.
std::vector<Cutout> make_cutouts(const std::vector<Material> &materials, const std::vector<Image> &images);

// The alpha at a triangle's point, as nodes compute it. bary: as Surface::bary.
float alpha_at(const AlphaImage &picture, const std::vector<Image> &images, const Mesh &mesh, uint32_t triangle,
               const glm::dvec2 &bary);

} // namespace lancer
