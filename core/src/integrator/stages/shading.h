// From a hit to its shading: the BSDF, emission and transmittance.
#pragma once

#include "bsdf/principled.h"
#include "compile/scene.h"
#include "lights/light.h"
#include "nodes/run.h"
#include "scene/camera.h"

#include <cmath>
#include <limits>

namespace lancer {

// A surface as seen from one direction.
struct Shaded {
  const Material *material = nullptr; // null: an instance without slots, black
  Bsdf<float> bsdf;
  glm::vec3 emission{0.0f};
  glm::vec3 transmittance{0.0f}; // share of light that passes straight through
  float holdout = 0.0f;          // share that becomes a hole in the picture

  bool is_transparent() const { return transmittance != glm::vec3(0.0f); }
  // Returns 1 minus the transmittance, in 0 ... 1.
  glm::vec3 opacity() const { return glm::clamp(1.0f - transmittance, 0.0f, 1.0f); }
};

// The view from which a material is evaluated.
struct View {
  glm::vec3 wo{0, 0, 1};   // unit, world, away from the surface
  float footprint = 0.0f;  // radius of a pixel's footprint there, normalised units
  LightPath<float> path{}; // of the ray that has hit the surface; for emission without a ray, the default
};

// Evaluates materials at surfaces. One object per thread: it keeps the nodes' values.
class Shader {
public:
  // camera may be null.
  Shader(const Scene &scene, const Camera *camera);

  void shade(const Surface &surface, const View &view, Shaded &result);
  // Returns the share of a shadow ray's light that passes straight through. path: of the ray up to there.
  glm::vec3 transmittance(const Ray &ray, const Hit &hit, const LightPath<float> &path);
  // Whether the surface is present at a hit on a mesh whose cutout has may_end set. Light passes an absent surface as if there
  // were none.
  bool is_there(uint32_t material, const Hit &hit);
  // Returns the emission alone, for light samples. path: of the vertex that samples the light.
  glm::vec3 emission(const Surface &surface, const glm::vec3 &wo, const LightPath<float> &path = {});
  std::span<glm::vec4> values() { return values_; }
  const Camera *camera() const { return context_.camera; }
  const NodeScene &node_scene() const { return context_; }
  // Evaluates surfaces of this geometry instead of the scene's; it must outlive the shader.
  void set_geometry(const Geometry &geometry) { context_.geometry = &geometry; }
  // Returns the value of one node of a material at a surface.
  glm::vec4 node_value(const Surface &surface, uint32_t node, const glm::vec3 &wo);

private:
  void run_painted(const Material &material, const Schedule &schedule, const Hit &hit);
  void run_nodes(const Material &material, const Schedule &schedule, const Surface &surface, const View &view);

  const Scene &scene_;
  NodeContext context_;
  std::vector<glm::vec4> values_; // of the nodes of one material at a time
  Shaded layered_;                // scratch for emission below layers
};

// Radius of a pixel's footprint: base at distance 0, plus spread per unit of distance; normalised units.
struct PixelCone {
  explicit PixelCone(const Camera &camera);
  double base = 0.0, spread = 0.0;
};

// Returns a shadow ray to a light's sample; ns, ng: of the surface's Bsdf.
Ray shadow_ray(const Geometry &geometry, const Surface &surface, const glm::vec3 &ns, const glm::vec3 &ng,
               const LightSample &sample);

// Light samples of any kind of light at a point.

// Samples a chosen light. choice: of scene.lights. pdf of the result, as in LightSample, excludes the choice of light and face.
// path: of the vertex that samples the light; its length is set here.
LightSample sample_scene_light(const Scene &scene, const LightSet::Choice &choice, const glm::dvec3 &p, const glm::vec2 &u,
                               Shader &shader, const LightPath<float> &path = {});
// Samples light number `light` of scene.lights; of an emitter, a face by its power.
LightSample sample_scene_light(const Scene &scene, uint32_t light, const glm::dvec3 &p, const glm::vec2 &u, Shader &shader);

// Returns the function that evaluates the emission of the scene's surfaces, for commit(). One thread at a time may call the
// function; the scene must outlive it.
EmissionAt surface_emission(const Scene &scene);

} // namespace lancer
