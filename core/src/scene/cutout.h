// Surfaces that the alpha of a picture cuts out, as leaves and fences are made: one look-up tells what passes.
#pragma once

#include "scene/material.h"

namespace lancer {

struct Cutout {
  uint32_t image = kNone; // kNone: only the nodes know
  uint32_t uv_map = 0;    // number of the name
  Extension extension = Extension::Repeat;
  Interpolation interpolation = Interpolation::Linear;
  bool nothing_beside = false; // where all light passes nothing else happens to it

  bool known() const { return image != kNone; }
};

// By number of material: those whose transmittance is 1 - alpha of one picture that lies on a UV map.
std::vector<Cutout> make_cutouts(const std::vector<Material> &materials, const std::vector<Image> &images);

// Share of light that passes a triangle's point, as the nodes compute it. bary: as Surface::bary.
float cutout_transmittance(const Cutout &cutout, const std::vector<Image> &images, const Mesh &mesh, uint32_t triangle,
                           const glm::dvec2 &bary);

} // namespace lancer
