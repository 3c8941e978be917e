// What a path carries from vertex to vertex.
#pragma once

#include "integrator/sample.h"
#include "lancer.h"
#include "lights/light.h"
#include "nodes/light_path.h"
#include "sampling/sobol.h"

#include <algorithm>

namespace lancer {

struct Path {
  Path(const Sampler &numbers, uint32_t result) : sampler(numbers), slot(result) {}

  Sampler sampler;
  glm::vec3 beta{1.0f};
  glm::dvec3 from{0.0};   // last scattering point
  glm::vec3 normal{0.0f}; // there, and whether light may come through: what light samples are chosen by
  bool transmits = false;
  double pdf = 0.0;     // of the BSDF sample that made the ray; 0 after the camera or a single direction
  uint32_t slot;        // of its sample's result
  bool split = false;   // the sample has split
  uint32_t branch = 0;  // number among its paths
  uint32_t sharers = 1; // how many paths share its weight
  bool leads = true;    // drawn evenly from them: what the camera sees is told by this one alone
  uint32_t scatterings = 0;
  uint32_t kinds = LANCER_RAY_CAMERA; // of the ray
  uint32_t layers = 0;                // passed straight through since the last scattering
  uint32_t passed_through = 0;        // and in all
  PathStory story;                    // for nodes that ask
  bool in_view = true;                // what it meets is still the picture itself: nothing reflected, no glass that counts
  bool last = false;                  // the next surface ends it
  double passed = 0.0;                // length of the way since the last scattering, through layers
  double length = 0.0;                // of the whole way

  // How many layers it may still pass straight through: limit in all, but one at least. Beyond them the next surface shows
  // its own light only.
  uint32_t crossings_left(uint32_t limit) const {
    return last ? 0u : std::min(std::max(limit, passed_through + 1) - passed_through, kMaxCrossings - 1 - layers);
  }
  void count_crossings(uint32_t count, uint32_t limit) {
    layers += count;
    passed_through += count;
    last = passed_through >= limit;
  }
  // pass: share of the paths here that pass straight on.
  bool chooses_to_pass(float pass) const {
    const uint32_t dimension = kDimensionOpacity + 2 * (scatterings * kMaxCrossings + layers);
    return pass > 0.0f && (pass >= 1.0f || sampler.get1(dimension) < pass);
  }
  // First of the numbers of the vertex that it is at.
  uint32_t vertex_dimension() const { return kDimensionVertex + scatterings * kVertexStride; }
  // Whether it is of the first sample of its pixel. paths: that samples split into.
  bool is_first(uint32_t paths) const { return sampler.sample() < (split ? paths : 1u); }
  // Which of so many paths that it splits into leads them.
  uint32_t leader_of(uint32_t count) const {
    return std::min(uint32_t(sampler.get1(vertex_dimension() + kVertexRoulette) * float(count)), count - 1);
  }
  // As the last scattering asked for light.
  LightQuery light_query() const { return LightQuery(from, normal, transmits); }
  // What nodes see of it. length: of its ray, in scene units, from where it may meet something.
  LightPath<float> light_path(double ray_length) const { return story.told(float(ray_length), scatterings, passed_through); }
  // The same where a vertex asks for light: it counts as a scattering, as in Cycles.
  LightPath<float> asking_path() const {
    LightPath<float> asking = story.told(0.0f, scatterings + 1, passed_through);
    asking.kinds = 0;
    return asking;
  }
};

} // namespace lancer
