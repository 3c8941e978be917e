// Materials whose colour is a picture that lies on a mesh by its UV map, and nothing else that nodes say but, maybe, that the
// surface is missing where the picture is clear. Kernels look it up, and shadow rays ask for its alpha alone.
#pragma once

#include "bsdf/wide_lobe.h"
#include "scene/material.h"
#include "scene/wide_image.h"

namespace lancer {

struct ColorPicture {
  const Image *image = nullptr; // null: not such a material
  WideImage wide;
  Extension extension = Extension::Repeat;
  uint32_t uv_map = 0; // number of the name
  glm::vec3 weight{1.0f};
  bool covers = false;   // the weight is alpha instead
  bool weighted = false; // the colour is multiplied by the weight: of NodeColors
  bool clears = false;   // whole - alpha passes straight on
  bool clamped = false;  // alpha, to 0 ... 1
  float whole = 1.0f;
};

// By number of material, of those that kernels shade. As long as the images are neither changed nor moved.
std::vector<ColorPicture> make_color_pictures(const std::vector<Material> &materials, const std::vector<WideMaterial> &wide,
                                              const std::vector<Image> &images);

} // namespace lancer
