// Surfaces that are absent at some places by their transmittance, such as leaves and fences that images cut out.
#pragma once

#include "scene/material.h"
#include "scene/node.h"

#include <optional>

namespace lancer {

// An image whose place on a mesh depends on a UV map alone.
struct FlatImage {
  const ImageView *image = nullptr;
  uint32_t uv_map = 0; // number of its name
  Extension extension = Extension::Repeat;
  Interpolation interpolation = Interpolation::Linear;

  bool known() const { return image != nullptr; }
};

// Returns the image whose colour a parameter is; known() is false if the parameter is not the colour of a flat image.
FlatImage flat_image(const ProgramView &program, const Parameter &color);

// The alpha of an image: unchanged, or clamped to 0 ... 1 as the factor of a shader mix.
struct ImageAlpha {
  Parameter picture; // colour of the image
  bool clamped = false;
};
// Returns nothing where the value is anything else.
std::optional<ImageAlpha> image_alpha(const ProgramView &program, const Parameter &value);

inline float clamped_alpha(float alpha, bool clamped) { return clamped ? glm::clamp(alpha, 0.0f, 1.0f) : alpha; }

// A constant minus the result of nodes: the transmittance of a surface with partial coverage.
struct Remainder {
  float whole = 1.0f;
  Parameter share;
};
// Returns nothing where the value is anything else.
std::optional<Remainder> remainder_of(const ProgramView &program, const Parameter &value);

// A surface cut out by an image: its transmittance is known without shading.

// The alpha of one image.
struct AlphaImage : FlatImage {
  bool clamped = false; // to 0 ... 1
};

struct Cutout {
  AlphaImage alpha;             // known: the transmittance is 1 - alpha
  bool painted = false;         // the transmittance depends on the place within a triangle alone
  bool may_end = false;         // the surface may vanish at some places: see Shader::is_there()
  bool ends_with_alpha = false; // the surface vanishes where alpha is 0
  Schedule nodes;               // of the transmittance and the lobes' weights
};

// The material's memory must outlive the record.
Cutout make_cutout(const MaterialView &material);

// Returns the alpha at a point of a triangle, as nodes compute it. bary: as Surface::bary.
float alpha_at(const AlphaImage &picture, const MeshView &mesh, uint32_t triangle, const glm::dvec2 &bary);

} // namespace lancer
