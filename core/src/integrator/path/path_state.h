// The state of a path from vertex to vertex, beside its ray and its last scattering.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/numbers.h"
#include "nodes/light_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lancer {

struct Path {
  Path(const Sampler &numbers, uint32_t result) : sampler(numbers), sample(result) {}

  Sampler sampler;
  glm::vec3 beta{1.0f};
  uint32_t sample;      // number in the batch
  bool split = false;   // the sample has split
  uint32_t branch = 0;  // number among its sample's paths
  uint32_t sharers = 1; // number of paths that share its weight
  bool leads = true; // the leader, chosen uniformly among the branches: it alone records the first surface, guides, occlusion
  uint32_t scatterings = 0;
  uint32_t kinds = RayKind::Camera; // of the ray
  uint32_t crossings = 0;           // transparent surfaces passed since the last scattering
  uint32_t passed_through = 0;      // transparent surfaces passed in all
  PathStory story;                  // for nodes that read it
  bool in_view = true;        // since the camera, the path has passed straight on or through clear glass alone; set by PATH
  bool sharp = true;          // no ray since the camera was sampled by a wide lobe
  bool last = false;          // the path ends at the next surface
  uint32_t entries = 0;       // walks below surfaces so far
  bool leaving = false;       // the path is at the end of a walk
  bool dimmed = false;        // Principled of Blender 3 has sent it below, whose exit Fresnel's weight dims
  bool after_diffuse = false; // a diffuse lobe has scattered the path
  Ghost ghost = Ghost::None;  // the light goes into no film
  bool fresh = false;         // a ghost that has not been scattered yet
  bool filtered = false;      // a surface has been met whose lobes filter_glossy may change
  bool caught = false;        // the camera sees a shadow catcher here: the rest of the path is in no pass of light
  bool of_catchers = false;   // the path goes among shadow catchers alone
  float least_pdf = std::numeric_limits<float>::infinity(); // least density of a scattering, single directions apart
  double length = 0.0;                                      // of the whole path, normalised units; set by PATH
  // Width of a pixel where the ray starts, and its growth along the ray, as in Cycles; set by PATH where images have mipmaps.
  float width = 0.0f, spread = 0.0f;

  // Returns the number of surfaces that the path may still pass straight through: up to limit on the whole path, and at least
  // one unless the path is at its last surface. After these, the path ends at the next surface and gets only the light that
  // this surface emits.
  uint32_t crossings_left(uint32_t limit) const {
    return last ? 0u : std::min(std::max(limit, passed_through + 1) - passed_through, kMaxCrossings - 1 - crossings);
  }
  // Whether the path scatters no more at its next surface, by its number of scatterings.
  bool is_spent(const IntegratorSettings &settings) const {
    return last || scatterings > settings.max_bounces || is_fast(settings);
  }
  // Whether the rest of the path is replaced: its ray ends at a near surface, or sees a changed environment.
  bool is_fast(const IntegratorSettings &settings) const {
    return settings.fast_bounces != 0 && ghost != Ghost::Followed &&
           scatterings + 1 > settings.fast_bounces + story.transmission + uint32_t(story.glossy > 0);
  }
  // Whether a limit of a kind of scatterings ends the path there.
  bool is_over_limit(const IntegratorSettings &settings) const {
    return obeys_limits(ghost) && (story.diffuse > settings.diffuse_bounces || story.glossy > settings.glossy_bounces ||
                                   story.transmission > settings.transmission_bounces);
  }
  // Whether the next surface shows no caustics, where the settings leave them out: the ray leaves a diffuse lobe.
  bool lacks_caustics() const { return obeys_limits(ghost) && (story.kinds & RayKind::Diffuse) != 0; }
  // Returns the least alpha of glossy lobes at the next surface; filter: filter_glossy.
  float least_alpha(float filter) const {
    return least_pdf < filter && ghost != Ghost::Sharp ? 0.5f * std::sqrt(1.0f - least_pdf / filter) : 0.0f;
  }
  // Makes the path a ghost, at a surface or on the way from one.
  void haunt(Ghost cause, bool at_surface) {
    ghost = cause;
    fresh = at_surface;
    split = true;
    leads = in_view = false;
    beta *= float(paths_of(cause));
  }
  // Sends the path among shadow catchers alone.
  void leave_others() {
    of_catchers = true;
    leads = false;
    kinds = among_catchers(kinds);
  }
  void count_crossings(uint32_t count, uint32_t limit) {
    crossings += count;
    passed_through += count;
    last = passed_through >= limit;
  }
  // Makes the path a branch of its sample, which splits into count paths.
  void split_off(uint32_t number, uint32_t count, uint32_t leader) {
    sampler = Sampler(sampler.pixel(), sampler.sample() * count + number);
    branch = number;
    sharers = count;
    split = true;
    leads = leads && number == leader;
  }
  // Continues the path by a ray of this kind. throughput: of the ray; pdf: of its direction, 0: a single one.
  void scatter(const glm::vec3 &throughput, uint32_t kind, bool is_diffuse, bool transmitted, double pdf) {
    const bool singular = pdf == 0.0;
    fresh = false;
    if (!singular)
      least_pdf = std::min(least_pdf, float(pdf));
    beta = throughput;
    kinds = of_catchers ? among_catchers(kind) : kind;
    crossings = 0;
    ++scatterings;
    leaving = false;
    after_diffuse = after_diffuse || is_diffuse;
    story.scatter(is_diffuse, transmitted, singular);
  }
  // Sends the path below the surface. A walk is no scattering that counts.
  void enter(const glm::vec3 &throughput, bool dimmed_exit) {
    beta = throughput;
    kinds &= ~kCameraKinds;
    story.kinds &= uint16_t(~uint32_t(RayKind::Camera));
    ++entries;
    leaving = true;
    dimmed = dimmed_exit;
    in_view = false;
  }
  // pass: probability of passing straight through.
  bool chooses_to_pass(float pass) const {
    const uint32_t dimension = kDimensionOpacity + 2 * (scatterings * kMaxCrossings + crossings);
    return pass > 0.0f && (pass >= 1.0f || sampler.get1(dimension) < pass);
  }
  // Returns a number in [0, 1) for the choice among the ways straight on, after chooses_to_pass().
  float way_number(float pass) const {
    const uint32_t dimension = kDimensionOpacity + 2 * (scatterings * kMaxCrossings + crossings);
    return std::min(sampler.get1(dimension) / std::min(pass, 1.0f), 1.0f - 0x1p-24f);
  }
  // Returns the dimension of the numbers of nodes' rays at the path's current surface.
  uint32_t nodes_dimension() const { return kDimensionNodes + 2 * ((scatterings + entries) * kMaxCrossings + crossings); }
  // Returns the key of the estimates at the path's current surface.
  uint32_t estimates_key() const { return hash_combine(hash_combine(sampler.pixel(), sampler.sample()), nodes_dimension()); }
  // Returns the first dimension of the path's current vertex.
  uint32_t vertex_dimension() const { return kDimensionVertex + (scatterings + entries) * kVertexStride; }
  // Whether the path belongs to the first sample of its pixel. paths: number of paths after a split.
  bool is_first(uint32_t paths) const { return sampler.sample() < (split ? paths : 1u); }
  // Returns the number of the leader when the path splits into count paths.
  uint32_t leader_of(uint32_t count) const {
    return std::min(uint32_t(sampler.get1(vertex_dimension() + kVertexRoulette) * float(count)), count - 1);
  }
  // Whether the ray shows a light or an environment that is hidden from some kinds of rays. Diffuse transmission is of two
  // kinds.
  bool shows_light(uint32_t hidden_from) const { return !((kinds | (story.kinds & RayKind::Diffuse)) & hidden_from); }
  // Goes on by this distance along the ray, in normalised units.
  void go(double distance) {
    length += distance;
    width += float(distance) * spread;
  }
  // Returns the Light Path values for nodes at this distance along the ray, in normalised units. ray_length: of the ray, from
  // its start, in the user's units.
  LightPath<float> light_path(double ray_length, double distance) const {
    LightPath<float> told = story.told(float(ray_length), scatterings, passed_through);
    told.width = width + float(distance) * spread;
    told.spread = spread;
    return told;
  }
  // Returns the Light Path values for a light sample at a vertex, which counts as a scattering, as in Cycles.
  LightPath<float> asking_path() const {
    LightPath<float> asking = story.told(0.0f, scatterings + 1, passed_through);
    asking.kinds = 0;
    return asking;
  }
};

} // namespace lancer
