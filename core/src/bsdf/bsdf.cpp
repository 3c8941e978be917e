#include "bsdf/bsdf.h"

#include <algorithm>

namespace lancer {

namespace {

bool lets_through(const Lobe &lobe) {
  return (lobe.shape == LobeShape::Microfacet && refracts(lobe)) || lobe.shape == LobeShape::Dielectric ||
         (lobe.shape == LobeShape::Matte && lobe.variant == static_cast<uint8_t>(Matte::Translucent));
}

bool scatters_beyond_albedo(const Lobe &lobe) {
  return lobe.shape == LobeShape::Microfacet && !reflects(lobe) && !lobe.delta && !lobe.delta_through;
}

} // namespace

void Bsdf::begin(const glm::vec3 &wo_, const glm::vec3 &ns_, const glm::vec3 &ng_, bool inside_, bool bump_correction_) {
  wo = wo_;
  ns = ns_;
  ng = ng_;
  inside = inside_;
  bump_correction = bump_correction_;
  flat = ns == ng;
  smooth = false;
  frames[0] = Frame(ns);
  wo_local[0] = frames[0].to_local(wo);
  frame_count = 1;
  count = 0;
  shapes = 0;
  emission = glm::vec3(0.0f);
}

void Bsdf::complete() {
  // Lobes are picked by the light that they are expected to scatter.
  float sum = 0.0f;
  smooth = transmits = false;
  for (int i = 0; i < count; ++i) {
    // The albedo of rough refraction is that of the smooth surface, which may reflect all where tilted facets do not.
    const glm::vec3 &expected = scatters_beyond_albedo(lobes[i]) ? lobes[i].color : lobes[i].albedo;
    sum += lobes[i].probability = std::max({expected.x, expected.y, expected.z, 0.0f});
    smooth = smooth || !lobes[i].delta;
    transmits = transmits || lets_through(lobes[i]);
  }
  for (int i = 0; i < count; ++i)
    lobes[i].probability = sum > 0.0f ? lobes[i].probability / sum : 0.0f;
}

glm::vec3 Bsdf::albedo() const {
  glm::vec3 sum(0.0f);
  for (int i = 0; i < count; ++i)
    sum += lobes[i].albedo;
  return sum;
}

glm::vec3 Bsdf::shown(Component component) const {
  glm::vec3 sum(0.0f);
  for (int i = 0; i < count; ++i) {
    const Lobe &lobe = lobes[i];
    if (lobe.component == component)
      sum += lobe.shown > 0.0f ? lobe.shown * lobe.color : lobe.albedo - lobe.through;
    if (component == Component::Transmission)
      sum += lobe.through;
  }
  return sum;
}

} // namespace lancer
