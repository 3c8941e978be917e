// Surfaces under the course's light side by side: from the surface to its light and its mirrored ray. Plain numbers: kernels
// read and write it.
#pragma once

#include <cstdint>

namespace lancer {

inline constexpr int kCourseLanes = 16;

// What kernels know of a material: a matt lobe and a rough coating, either may be missing.
struct WideCourse {
  bool known = false; // else only the general code does it
  bool matte = false, coated = false;
  bool shines = false; // it emits, or has Ka
  float kd[3] = {}, ks[3] = {};
  float alpha = 1.0f, ior = 1.5f; // of the coating
};

// Arrays come first, each a multiple of 64 bytes.
struct alignas(64) CourseBlock {
  using Floats = float[kCourseLanes];
  using Doubles = double[kCourseLanes];

  // Given: the ray that met the surface, of any length, and where; the material; the branch's weight.
  Doubles o[3], d[3], t;
  const double *placement[kCourseLanes]; // Instance::to_world and what follows
  // The surface, its normals outwards. Given, but of spheres and planes: look() finds those.
  Doubles p[3], offset;
  Floats ng[3], ns[3];
  Floats kd[3], ks[3], alpha, ior;
  Floats weight[3];

  // look(): from the viewer's side.
  Doubles next_origin[3];             // of the mirrored ray
  Floats mirrored[3], next_weight[3]; // its direction, the weight of what it brings
  Floats viewer_ng[3], viewer_ns[3], tangent[3], bitangent[3];
  Floats wo[3]; // local

  // Given.
  uint32_t count = 0;             // lanes in use, the first ones
  uint32_t matte = 0, coated = 0; // bits of lanes
  uint32_t sphere = 0, plane = 0; // bits of lanes
  float threshold = 0.0f;         // a mirrored ray of no more weight is not sent
  // look(): bits of lanes.
  uint32_t odd = 0;     // only the general code can do them
  uint32_t goes_on = 0; // there is a mirrored ray
};

// A lamp as all lanes ask it.
struct CourseLamp {
  bool point = false;  // one without extent; else light's samples are given
  bool unseen = false; // no surface shows its light
  double position[3] = {}, emission[3] = {};
  float diffuse[3] = {}, specular[3] = {}; // colours, black where the lamp is hidden from such rays
};

// What one lamp does to every lane of a block.
struct alignas(64) CourseLit {
  // Given, but of a point: the sample, and the irradiance at normal incidence.
  CourseBlock::Doubles wi[3], target[3];
  CourseBlock::Floats irradiance[3];
  // light(): the contribution of the branch where nothing is in the way of the shadow ray.
  CourseBlock::Floats contribution[3];
  CourseBlock::Doubles origin[3], d[3];

  // Bits of lanes.
  uint32_t there = 0, far = 0; // given, but of a point: with a sample, those without target
  uint32_t lit = 0;            // light(): those that want a shadow ray
};

} // namespace lancer
