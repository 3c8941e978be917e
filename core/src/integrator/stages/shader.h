// Materials at one hit at a time: what a ray meets that passes surfaces during its traversal.
#pragma once

#include "bsdf/bsdf.h"
#include "compile/scene.h"
#include "nodes/run.h"

namespace lancer {

// A surface as seen from one direction.
struct Shaded {
  const MaterialView *material = nullptr; // null: an instance without slots, black
  Bsdf<float> bsdf;
  glm::vec3 emission{0.0f};
  glm::vec3 transmittance{0.0f}; // share of light that passes straight through

  // Returns 1 minus the transmittance, in 0 ... 1.
  glm::vec3 opacity() const { return glm::clamp(1.0f - transmittance, 0.0f, 1.0f); }
};

// Evaluates materials at surfaces. One object per thread: it keeps the nodes' values.
class Shader {
public:
  // camera may be null.
  Shader(const Scene &scene, const Camera *camera)
      : scene_(scene), nodes_(scene.node_scene(camera), most_values(scene.materials)) {}

  // seen_by_camera: see Bsdf.
  void shade(const Surface &surface, const View &view, Shaded &result, bool seen_by_camera = true);
  // Returns the values of a material's outputs, as their parameters read them; valid until the next call.
  std::span<const glm::vec4> outputs(const MaterialView &material, const Surface &surface, const View &view) {
    nodes_.run(material.program, material.output_nodes, surface, view);
    return nodes_.values();
  }
  // Returns the share of a shadow ray's light that passes straight through. path: of the ray up to there.
  glm::vec3 transmittance(const Ray &ray, const Hit &hit, const LightPath<float> &path);
  // Whether the surface is present at a hit on a mesh whose cutout has may_end set. Light passes an absent surface as if there
  // were none.
  bool is_there(uint32_t material, const Hit &hit);
  // Evaluates surfaces of this geometry instead of the scene's; it must outlive the shader.
  void set_geometry(const GeometryView &geometry) { nodes_.set_geometry(geometry); }
  // Returns the value of one node of a material at a surface.
  glm::vec4 node_value(const Surface &surface, uint32_t node, const glm::vec3 &wo);

private:
  glm::vec3 transmittance_by_lobes(const Ray &ray, const Hit &hit, const MaterialView &material, const LightPath<float> &path);

  const Scene &scene_;
  MaterialNodes nodes_;
  Shaded shaded_;
};

} // namespace lancer
