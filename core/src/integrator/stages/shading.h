// From a hit to what the integrators ask of it: the BSDF, what it emits, what passes straight through.
#pragma once

#include "bsdf/principled.h"
#include "compile/scene.h"
#include "lights/light.h"
#include "nodes/run.h"
#include "scene/camera.h"

#include <cmath>
#include <limits>

namespace lancer {

// A surface as one direction sees it.
struct Shaded {
  const Material *material = nullptr; // null: an instance without slots, black
  Bsdf<float> bsdf;
  glm::vec3 emission{0.0f};
  glm::vec3 transmittance{0.0f}; // share of light that passes straight on
  float holdout = 0.0f;          // share that becomes a hole in the picture

  bool is_transparent() const { return transmittance != glm::vec3(0.0f); }
  // The share that is there.
  glm::vec3 opacity() const { return glm::clamp(1.0f - transmittance, 0.0f, 1.0f); }
};

// How the viewer sees the surface that a material is evaluated for.
struct View {
  glm::vec3 wo{0, 0, 1};   // unit, world, away from the surface
  float footprint = 0.0f;  // radius that a pixel covers there, normalised units
  LightPath<float> path{}; // of the ray that has met it; asked of a light by no ray
};

// Evaluates materials at surfaces. One object per thread: it keeps the nodes' values.
class Shader {
public:
  // camera may be null.
  Shader(const Scene &scene, const Camera *camera);

  void shade(const Surface &surface, const View &view, Shaded &result);
  // Share of a shadow ray's light that passes straight on. path: of the ray up to there.
  glm::vec3 transmittance(const Ray &ray, const Hit &hit, const LightPath<float> &path);
  // Whether there is anything of a surface of a mesh whose cutout may end; where not, light passes as if there were no surface.
  bool is_there(uint32_t material, const Hit &hit);
  // By itself, for light samples. path: of what asks.
  glm::vec3 emission(const Surface &surface, const glm::vec3 &wo, const LightPath<float> &path = {});
  std::span<glm::vec4> values() { return values_; }
  const Camera *camera() const { return context_.camera; }
  const NodeScene &node_scene() const { return context_; }
  // Looks at surfaces of this geometry instead of the scene's; it must outlive the shader.
  void set_geometry(const Geometry &geometry) { context_.geometry = &geometry; }
  // The value of one node of a material at a surface.
  glm::vec4 node_value(const Surface &surface, uint32_t node, const glm::vec3 &wo);

private:
  void run_painted(const Material &material, const Schedule &schedule, const Hit &hit);
  void run_nodes(const Material &material, const Schedule &schedule, const Surface &surface, const View &view);

  const Scene &scene_;
  NodeContext context_;
  std::vector<glm::vec4> values_; // of the nodes of one material at a time
  Shaded layered_;                // scratch for emission below layers
};

// The size of a pixel's view: at distance 0, and what it grows by per unit of distance; normalised units.
struct PixelCone {
  explicit PixelCone(const Camera &camera);
  double base = 0.0, spread = 0.0;
};

// A shadow ray to a light's sample; ns, ng: of the surface's Bsdf.
Ray shadow_ray(const Geometry &geometry, const Surface &surface, const glm::vec3 &ns, const glm::vec3 &ng,
               const LightSample &sample);

// One question for every kind of light: what arrives at a point from a sample of it.

// choice: of scene.lights; see LightSample. pdf is that of the point once light and face are chosen. path: of what asks, its
// length not yet known.
LightSample sample_scene_light(const Scene &scene, const LightSet::Choice &choice, const glm::dvec3 &p, const glm::vec2 &u,
                               Shader &shader, const LightPath<float> &path = {});
// All of a light by itself, number light of scene.lights: of an emitter, a face by its power.
LightSample sample_scene_light(const Scene &scene, uint32_t light, const glm::dvec3 &p, const glm::vec2 &u, Shader &shader);

// What the scene's surfaces emit, for commit(); by one thread at a time. The scene must outlive the answer.
EmissionAt surface_emission(const Scene &scene);

} // namespace lancer
