// Surfaces that pictures cut out, as leaves and fences are made: their transmittance is known without
// shading them.
#pragma once

#include "scene/flat_picture.h"
#include "scene/material.h"

namespace lancer {

// The alpha of one picture.
struct AlphaPicture : FlatPicture {
  bool clamped = false; // to 0 ... 1
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
