#include "integrator/course_light.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

// The lectures' attenuation; ratio = d / r.
double attenuation(Falloff falloff, double ratio) {
  const double rest = std::max(0.0, 1.0 - ratio * ratio);
  switch (falloff) {
  case Falloff::Linear:
    return std::max(0.0, 1.0 - ratio);
  case Falloff::Quadratic:
    return rest;
  case Falloff::Smooth:
    return rest * rest;
  case Falloff::Gaussian:
    return std::exp(-ratio * ratio);
  case Falloff::Physical:
  case Falloff::Constant:
    break;
  }
  return 1.0;
}

// A power of a cosine that is 0 from behind; x^0 is 1 in front.
float lobe_power(float cosine, float n) { return cosine > 0.0f ? std::pow(std::min(cosine, 1.0f), n) : 0.0f; }

} // namespace

glm::vec3 course_irradiance(const CourseLight &course, const LightSample &sample) {
  const glm::dvec3 physical = glm::dvec3(sample.radiance) / sample.pdf;
  if (course.falloff == Falloff::Physical || std::isinf(sample.distance))
    return glm::vec3(physical);
  // Undo the inverse square in world units, then attenuate as the light asks.
  const double d = sample.distance / course.world_unit;
  const double ratio = course.radius > 0.0 ? sample.distance / course.radius : std::numeric_limits<double>::infinity();
  return glm::vec3(physical * (d * d * attenuation(course.falloff, ratio)));
}

glm::vec3 course_illumination(const Bsdf &bsdf, const LitPoint &point, const glm::vec3 &wi_world, const CourseLight &course,
                              const glm::vec3 &irradiance) {
  // Look at both directions from the side that the viewer is on.
  glm::vec3 wo = point.wo, wi = point.frame.to_local(wi_world);
  if (wo.z < 0.0f) {
    wo.z = -wo.z;
    wi.z = -wi.z;
  }
  if (!(wi.z > 0.0f) || !(wo.z > 0.0f))
    return glm::vec3(0.0f);
  const glm::vec3 h = half_vector(wo, wi);
  glm::vec3 diffuse(0.0f), specular(0.0f);
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe &lobe = bsdf.lobes[i];
    switch (lobe.kind) {
    case LobeKind::Lambert:
      diffuse += lobe.color * (kInvPi * wi.z);
      break;
    case LobeKind::Beckmann:
      if (lobe.alpha >= kMirrorAlpha)
        specular += lobe.color * (microfacet_eval_pdf(lobe, wo, wi, h).f * wi.z);
      break;
    case LobeKind::Phong:
      specular += lobe.color * (kInvPi * lobe_power(glm::dot(reflect_local(wi), wo), lobe.shininess));
      break;
    case LobeKind::BlinnPhong:
      specular += lobe.color * (kInvPi * lobe_power(h.z, lobe.shininess));
      break;
    case LobeKind::Mirror:
    case LobeKind::Dielectric:
      break;
    }
  }
  return irradiance * (diffuse * course.diffuse_color + specular * course.specular_color);
}

CourseBranches course_branches(const Bsdf &bsdf, const glm::vec3 &wo, bool outside) {
  CourseBranches branches;
  const float cosine = std::abs(wo.z);
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe &lobe = bsdf.lobes[i];
    if (lobe.kind == LobeKind::Mirror)
      branches.reflected += lobe.color;
    if (lobe.kind == LobeKind::Beckmann)
      branches.reflected += lobe.color * fresnel_dielectric(cosine, lobe.ior);
    if (lobe.kind == LobeKind::Dielectric) {
      const float eta = outside ? lobe.ior : 1.0f / lobe.ior;
      const Fresnel boundary = fresnel(cosine, eta);
      branches.reflected += lobe.color * boundary.reflectance;
      branches.refracted += lobe.color * (1.0f - boundary.reflectance);
      branches.eta = eta;
      branches.cos_t = boundary.cos_t;
    }
  }
  return branches;
}

} // namespace lancer
