// The lobes of a material as kernels read them for many lanes at once: plain numbers, in the order in which they are added.
#pragma once

#include <cstdint>

namespace lancer {

inline constexpr int kWideLobes = 5;

// How a lobe's colour comes from what the lobes before it have left.
enum class WideMode : uint32_t {
  Own = 0,   // it does not: the material's base alone
  Share = 1, // share of what is left, which the others lose
  Layer = 2, // share of what is left, and those below lose what it scatters
  Base = 3,  // the material's base times what is left
  Given = 4  // neither the one nor the other: its own
};

enum class WideShape : uint32_t { Nothing = 0, Lambert = 1, Microfacet = 2 };

// Fields as in Lobe and MicrofacetPlan.
struct WideLobe {
  WideShape shape = WideShape::Nothing;
  WideMode mode = WideMode::Own;
  float share = 1.0f;
  float color[3] = {}; // of WideMode::Given
  float alpha_x = 0.0f, alpha_y = 0.0f;
  uint32_t fresnel = 0; // FresnelKind
  float f0[3] = {}, f90[3] = {}, b[3] = {};
  float ior = 1.0f, lowest = 0.0f, per_range = 1.0f; // lowest of FresnelKind::Dielectric: the reflectance at the normal
  float reflection[3] = {}, transmission[3] = {};
  uint32_t delta = 0, delta_through = 0;
  uint32_t through = 0; // Scatter::Both
  uint32_t preserving = 0;
  uint32_t averaged = 0; // the albedo is the mean over the facets, read from rows
  float further[3] = {};
  const float *single = nullptr, *mix = nullptr; // rows of AlbedoRows
};

struct WideMaterial {
  uint32_t count = 0;                 // 0: not for kernels
  uint32_t bends = 0;                 // its lobes may want a bent normal
  uint32_t smooth = 0, transmits = 0; // as of Bsdf, where no lobe is black
  uint32_t inside = 0;                // the record for the inner side lies this far behind this one; 0: there is but one
  // Of all lobes together, and the colour of the matt one; where nodes say them they are those of the place.
  float weight[3] = {}, base[3] = {};
  uint32_t nodes = 0; // 1: nodes say these, what it emits or what it lets pass
  WideLobe lobes[kWideLobes];
};

} // namespace lancer
