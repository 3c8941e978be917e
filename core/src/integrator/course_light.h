// Local illumination as in the course's texts: one light, one point, no shadow.
#pragma once

#include "integrator/shading.h"

namespace lancer {

// A place that is lit: a hit point, or a vertex under Gouraud shading with its share of it.
struct LitPoint {
  glm::dvec3 p{0.0};
  const Bsdf<float> *bsdf = nullptr;
  float weight = 0.0f;
};

// The light from everywhere that Ka reflects: the world's own, else the environment where it is the same in all directions,
// else its mean.
glm::vec3 ambient_light(const Scene &scene, const Camera &camera);

// What the texts call lc, as irradiance at normal incidence from a light's sample, after the light's own attenuation.
// The attenuations other than PHYSICAL replace 1/d^2: such a light is at every distance d att(d) times what it is at one unit.
glm::vec3 course_irradiance(const CourseLight &course, const LightSample &sample);

// Sum of Kd/pi (l.n) lc and the specular lobes for one light; diffuse and specular colours of the light apply.
//   BECKMANN     Ks D F G / (4 (l.n)(v.n)) (l.n) lc
//   PHONG        Ks (R.V)^n lc / pi, BLINN_PHONG Ks (N.H)^n lc / pi: C of the lectures is lc / pi, so that Kd means the same
//   everywhere
// Lobes of other kinds give what they give in PATH, on the viewer's side. hidden: bits LANCER_RAY_* that the light is hidden
// from.
glm::vec3 course_illumination(const Bsdf<float> &bsdf, const glm::vec3 &wi, const CourseLight &course,
                              const glm::vec3 &irradiance, uint32_t hidden);

// Weights of the mirrored and of the refracted ray, F c_s and (1 - F) c_s summed over the lobes, and where they go: as the
// strongest lobe of each has it, about its own normal.
struct CourseBranches {
  glm::vec3 reflected{0.0f}, refracted{0.0f};
  glm::vec3 mirrored{0.0f}, through{0.0f}; // world
};
CourseBranches course_branches(const Bsdf<float> &bsdf);

} // namespace lancer
