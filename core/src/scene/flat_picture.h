// Pictures that lie flat on a mesh by its UV map, and the nodes that let their alpha decide how much of a surface is there.
#pragma once

#include "scene/node.h"

#include <optional>

namespace lancer {

struct FlatPicture {
  uint32_t image = kNone;
  uint32_t uv_map = 0; // number of the name
  Extension extension = Extension::Repeat;
  Interpolation interpolation = Interpolation::Linear;

  bool known() const { return image != kNone; }
};

// The picture that a colour is; not known where it is anything else.
FlatPicture flat_picture(const Program &program, const Parameter &color, const std::vector<Image> &images);

// The alpha of a picture, as it is or as a mix of shaders takes it for its factor: clamped to 0 ... 1.
struct PictureAlpha {
  Parameter picture; // its colour
  bool clamped = false;
};
// Nothing where the value is anything else.
std::optional<PictureAlpha> picture_alpha(const Program &program, const Parameter &value);

inline float clamped_alpha(float alpha, bool clamped) { return clamped ? glm::clamp(alpha, 0.0f, 1.0f) : alpha; }

// A constant less what nodes say, as surfaces that are there in part let light pass.
struct Remainder {
  float whole = 1.0f;
  Parameter share;
};
// Nothing where the value is anything else.
std::optional<Remainder> remainder_of(const Program &program, const Parameter &value);

} // namespace lancer
