// Local illumination as in the course's texts: one light, one point, no shadow.
#pragma once

#include "integrator/shading.h"

namespace lancer {

// A place that is lit: a hit point, or a vertex under Gouraud shading.
struct LitPoint {
  glm::dvec3 p{0.0};
  Frame frame{glm::vec3(0.0f, 0.0f, 1.0f)}; // of the normal
  glm::vec3 wo{0.0f};                       // local
};

// What the texts call lc, as irradiance at normal incidence from a light's sample, after the light's own attenuation.
// The attenuations other than PHYSICAL replace 1/d^2: such a light is at every distance d att(d) times what it is at one unit.
glm::vec3 course_irradiance(const CourseLight &course, const LightSample &sample);

// Sum of Kd/pi (l.n) lc and the specular lobes for one light; diffuse and specular colours of the light apply.
//   BECKMANN     Ks D F G / (4 (l.n)(v.n)) (l.n) lc
//   PHONG        Ks (R.V)^n lc / pi, BLINN_PHONG Ks (N.H)^n lc / pi: C of the lectures is lc / pi, so that Kd means the same
//   everywhere
glm::vec3 course_illumination(const Bsdf &bsdf, const LitPoint &point, const glm::vec3 &wi_world, const CourseLight &course,
                              const glm::vec3 &irradiance);

// Weights of the mirrored and of the refracted ray: F c_s and (1 - F) c_s, summed over the lobes. eta: of the refraction; 0 =
// none.
struct CourseBranches {
  glm::vec3 reflected{0.0f}, refracted{0.0f};
  float eta = 0.0f, cos_t = 0.0f;
};
CourseBranches course_branches(const Bsdf &bsdf, const glm::vec3 &wo, bool outside);

} // namespace lancer
