// Surfaces that pictures cut out, as leaves and fences are made: what passes is known without all that shading needs.
#pragma once

#include "scene/material.h"

namespace lancer {

// The alpha of one picture that lies on a UV map.
struct AlphaPicture {
  uint32_t image = kNone;
  uint32_t uv_map = 0; // number of the name
  Extension extension = Extension::Repeat;
  Interpolation interpolation = Interpolation::Linear;
  bool clamped = false; // to 0 ... 1

  bool known() const { return image != kNone; }
};

struct Cutout {
  AlphaPicture alpha;           // known: the transmittance is 1 - alpha
  bool painted = false;         // what passes depends on the place within a triangle alone
  bool may_end = false;         // there may be nothing of the surface at some places: see Shader::is_there()
  bool ends_with_alpha = false; // and that is where alpha is 0
  Schedule nodes;               // of transmittance and the lobes' weights
};

// By number of material.
std::vector<Cutout> make_cutouts(const std::vector<Material> &materials, const std::vector<Image> &images);

// The alpha at a triangle's point, as nodes compute it. bary: as Surface::bary.
float alpha_at(const AlphaPicture &picture, const std::vector<Image> &images, const Mesh &mesh, uint32_t triangle,
               const glm::dvec2 &bary);

} // namespace lancer
