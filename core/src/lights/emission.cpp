#include "lights/emission.h"

#include "bsdf/material_lobes.h"
#include "scene/color.h"

#include <algorithm>
#include <cmath>

namespace lancer {

bool is_light(const Material &material) { return material.emits() && !(material.flags & MaterialFlag::NotALight); }

bool emission_varies(const Material &material) { return material.emission.varies() || material.layered_emission; }

double emission_level(const glm::vec3 &radiance) {
  const double level = double(mean(glm::abs(radiance)));
  return std::isfinite(level) ? level : 0.0;
}

glm::vec3 EmissionAt::operator()(const Surface &surface, const glm::vec3 &wo, const LightPath<float> &path) {
  if (surface.material == kNone)
    return glm::vec3(0.0f);
  const Material *const material = &materials_[surface.material];
  const Schedule &nodes = material->layered_emission ? material->surface_nodes : material->emission_nodes;
  nodes_.run(material->program, nodes, surface, {.wo = wo, .path = path});
  const glm::vec3 own = nodes_.value(material->emission);
  if (!material->layered_emission)
    return own;
  // The layers above the emitting one depend on the direction: build all lobes.
  find_lobes<float>(&material, PlaceValues{nodes_.values()}, false, wo, surface.ns, surface.ng, bsdf_);
  return own + bsdf_.emission;
}

double EmissionAt::level(const Surface &surface) {
  const LightPath<float> path{.depth = 1.0f};
  return std::max(emission_level((*this)(surface, surface.ng, path)), emission_level((*this)(surface, -surface.ng, path)));
}

} // namespace lancer
