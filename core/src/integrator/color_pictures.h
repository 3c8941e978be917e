// Materials whose colour is a picture that lies on a mesh by its UV map, and nothing else that nodes say: kernels look it up.
#pragma once

#include "scene/scene.h"
#include "scene/wide_image.h"

namespace lancer {

struct ColorPicture {
  WideImage image;     // no texels: not such a material
  uint32_t uv_map = 0; // number of the name
  glm::vec3 weight{1.0f};
  bool weighted = false; // the colour is multiplied by the weight: of NodeColors
};

class ColorPictures {
public:
  // Of materials that kernels shade.
  explicit ColorPictures(const Scene &scene);
  const ColorPicture &of(uint32_t material) const { return of_[material]; }

private:
  std::vector<ColorPicture> of_;
};

} // namespace lancer
