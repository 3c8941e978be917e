// The nodes of materials at one surface at a time.
#pragma once

#include "nodes/run.h"
#include "scene/material.h"

#include <vector>

namespace lancer {

// The view from which a material is evaluated.
struct View {
  glm::vec3 wo{0, 0, 1};   // unit, world, away from the surface
  float footprint = 0.0f;  // radius of a pixel's footprint there, normalised units
  LightPath<float> path{}; // of the ray that has hit the surface; for emission without a ray, the default
};

// One object per thread: it keeps the values of the last run.
class MaterialNodes {
public:
  // nodes: the most nodes of a program.
  MaterialNodes(const NodeScene &scene, size_t nodes) : values_(nodes) { static_cast<NodeScene &>(context_) = scene; }

  // Evaluates surfaces of this geometry instead of the scene's; it must outlive this object.
  void set_geometry(const Geometry &geometry) { context_.geometry = &geometry; }
  const NodeScene &scene() const { return context_; }

  // Computes the scheduled nodes at a surface.
  void run(const Program &program, const Schedule &schedule, const Surface &surface, const View &view);
  // Computes nodes that read only the triangle and the place within it.
  void run_painted(const Program &program, const Schedule &schedule, const Hit &hit);
  // The results of the last run, by number of the node.
  std::span<glm::vec4> values() { return values_; }
  glm::vec3 value(const Parameter &parameter) const { return value_of(parameter, values_); }

private:
  NodeContext context_;
  std::vector<glm::vec4> values_;
};

// Returns the most nodes of a material's program.
size_t most_nodes(std::span<const Material> materials);

} // namespace lancer
