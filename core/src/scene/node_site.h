// The place at which nodes are evaluated, and what every family of nodes needs to know of it.
#pragma once

#include "scene/node.h"

namespace lancer {

struct Site {
  const NodeContext *context = nullptr;
  glm::dvec3 p{0.0};            // normalised world; for the world the direction
  glm::dvec2 bary{0.0};         // as Surface::bary
  glm::vec3 ns{0.0f}, ng{0.0f}; // towards the viewer
  bool backfacing = false;
  bool in_height = false; // a BUMP is looking at its own nodes

  explicit Site(const NodeContext &context);
  // The same surface, moved by an offset in its tangent plane (normalised world); its attributes as bump finds them there.
  Site moved(const glm::dvec3 &offset) const;

  const Surface *surface() const { return context->surface; }
  // Null for the world.
  const Instance *instance() const;
  // Null for the world and for exact surfaces.
  const Mesh *mesh() const;

  // Normals between the spaces, unit; 0 stays 0. The world's own frame is its object space.
  glm::vec3 normal_to_object(const glm::vec3 &n) const;
  glm::vec3 normal_to_world(const glm::vec3 &n) const;
};

// The inputs of one node, as values.
struct Inputs {
  const Node &node;
  std::span<const glm::vec4> values;

  glm::vec3 operator[](int i) const { return value_of(node.inputs[i], values); }
  float scalar(int i) const { return (*this)[i].x; }
  float alpha(int i) const { return node.inputs[i].node < 0 ? 1.0f : values[size_t(node.inputs[i].node)].w; }
  // The constant 0 stands for the shading normal.
  glm::vec3 normal(int i, const Site &site) const {
    return !node.inputs[i].varies() && node.inputs[i].value == glm::vec3(0.0f) ? site.ns : (*this)[i];
  }
};

inline glm::vec4 solid(const glm::vec3 &v) { return {v, 1.0f}; }
inline glm::vec4 scalar(float value) { return {value, value, value, 1.0f}; }

// The families.
glm::vec4 coordinate(const Node &node, const Site &site);
glm::vec4 attribute(const Node &node, const Site &site);
glm::vec4 image(const Inputs &in, const Site &site);
glm::vec4 environment(const Inputs &in, const Site &site);
glm::vec4 mapping(const Inputs &in);
// By Euler angles, x first.
glm::mat3 rotation(const glm::vec3 &angles);
glm::vec4 transform(const Inputs &in);
float math(uint32_t operation, float a, float b, float c);
glm::vec4 vector_math(const Inputs &in);
glm::vec4 mix(const Inputs &in);
glm::vec4 gamma(const Inputs &in);
glm::vec4 object_info(const Node &node, const Site &site);
glm::vec4 noise(const Inputs &in);
glm::vec4 voronoi(const Inputs &in);
glm::vec4 gradient(const Inputs &in);
glm::vec4 curves(const Inputs &in, const Site &site);
float fresnel_weight(const Inputs &in, const Site &site);
float layer_weight(const Inputs &in, const Site &site);
glm::vec3 normal_map(const Inputs &in, const Site &site);
glm::vec3 tangent(const Node &node, const Site &site);
glm::vec3 displacement(const Inputs &in, const Site &site);
// Runs the nodes of the height at three places; values end as they were.
glm::vec3 bump(const Program &program, const Inputs &in, const Site &site, std::span<glm::vec4> values);

// Computes the scheduled nodes at a site.
void run_at(const Program &program, const Schedule &schedule, const Site &site, std::span<glm::vec4> values);

} // namespace lancer
