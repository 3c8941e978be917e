#include "integrator/course_light.h"

#include "bsdf/coating.h"
#include "bsdf/microfacet_fresnel.h"
#include "bsdf/phong.h"
#include "sampling/color.h"
#include "sampling/elementary.h"

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
    return exp(-ratio * ratio);
  case Falloff::Physical:
  case Falloff::Constant:
    break;
  }
  return 1.0;
}

// A power of a cosine that is 0 from behind; x^0 is 1 in front.
float lobe_power(float cosine, float n) { return cosine > 0.0f ? pow(std::min(cosine, 1.0f), n) : 0.0f; }

constexpr uint32_t kCourseShapes = shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Beckmann) |
                                   shape_bit(LobeShape::Phong) | shape_bit(LobeShape::BlinnPhong);

// The direction that goes through a lobe's boundary; straight on where the index bends nothing.
glm::vec3 refracted(const Bsdf<float> &bsdf, const Lobe<float> &lobe, float cosine) {
  const Fresnel<float> boundary = fresnel(cosine, lobe.ior);
  if (lobe.ior == 1.0f || !(boundary.cos_t > 0.0f))
    return -bsdf.wo;
  return bsdf.frames[lobe.frame].to_world(refract_local(bsdf.wo_local[lobe.frame], lobe.ior, boundary.cos_t));
}

struct CourseShares {
  glm::vec3 reflected{0.0f}, refracted{0.0f};
};

// What a lobe mirrors of light and what it lets through, seen at that cosine to its normal.
CourseShares course_shares(const Lobe<float> &lobe, float cosine) {
  switch (lobe.shape) {
  case LobeShape::Mirror:
    return {lobe.color};
  case LobeShape::Beckmann:
    return {lobe.color * fresnel_dielectric(cosine, lobe.ior)};
  case LobeShape::Ashikhmin:
    return {lobe.albedo};
  case LobeShape::Dielectric:
    return {lobe.albedo - lobe.through, lobe.through};
  case LobeShape::Microfacet: {
    // What rough facets reflect on average; smooth ones, and those that let light through, answer as the one they are taken
    // for, so that no light is lost between the two shares.
    if (!lobe.delta && !refracts(lobe))
      return {lobe.albedo};
    const FacetResponse<float> response = facet_response(lobe, cosine);
    const glm::vec3 color = lobe.delta ? lobe.color * lobe.energy : lobe.color;
    return {color * response.reflected, color * response.through};
  }
  default:
    return {};
  }
}

} // namespace

glm::vec3 ambient_light(const Scene &scene, const Camera &camera) {
  if (scene.world.ambient)
    return *scene.world.ambient;
  const Environment &environment = scene.lights.environment();
  if (!environment.varies())
    return environment.constant();
  // The mean of the six directions of the axes: Ka is no more than a guess of light from everywhere.
  std::vector<glm::vec4> values(scene.world.program.nodes.size());
  glm::vec3 sum(0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 wi(0.0);
    for (double sign : {-1.0, 1.0}) {
      wi[axis] = sign;
      sum += environment.radiance(wi, values, &camera);
    }
  }
  return sum / 6.0f;
}

glm::vec3 course_irradiance(const CourseLight &course, const LightSample &sample) {
  const glm::dvec3 physical = glm::dvec3(sample.radiance) / sample.pdf;
  if (course.falloff == Falloff::Physical || std::isinf(sample.distance))
    return glm::vec3(physical);
  // Undo the inverse square in world units, then attenuate as the light asks.
  const double d = sample.distance / course.world_unit;
  const double ratio = course.radius > 0.0 ? sample.distance / course.radius : std::numeric_limits<double>::infinity();
  return glm::vec3(physical * (d * d * attenuation(course.falloff, ratio)));
}

glm::vec3 course_illumination(const Bsdf<float> &bsdf, const glm::vec3 &wi_world, const CourseLight &course,
                              const glm::vec3 &irradiance, uint32_t hidden) {
  glm::vec3 diffuse(0.0f), specular(0.0f);
  uint8_t frame = 0;
  glm::vec3 wi = bsdf.frames[0].to_local(wi_world);
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe<float> &lobe = bsdf.lobes[i];
    const glm::vec3 &wo = bsdf.wo_local[lobe.frame];
    if (lobe.frame != frame) {
      frame = lobe.frame;
      wi = bsdf.frames[frame].to_local(wi_world);
    }
    if (!(wi.z > 0.0f))
      continue;
    if (lobe.shape == LobeShape::Lambert)
      diffuse += lobe.color * (kInvPi * wi.z);
    else if (!(wo.z > 0.0f))
      continue;
    else if (const glm::vec3 h = half_vector(wo, wi); lobe.shape == LobeShape::Beckmann && !lobe.delta)
      specular += lobe.color * (coating_eval(lobe, wo, wi, h, coating_d(lobe, wo, h)) * wi.z);
    else if (lobe.shape == LobeShape::Phong)
      specular += lobe.color * (kInvPi * lobe_power(glm::dot(reflect_local(wi), wo), lobe.shininess));
    else if (lobe.shape == LobeShape::BlinnPhong)
      specular += lobe.color * (kInvPi * lobe_power(half_vector(wo, wi).z, lobe.shininess));
  }
  // Lobes that the course does not know answer as they do in PATH.
  const BsdfValue<float> rest = bsdf.eval_lit(wi_world, kAllShapes & ~kCourseShapes);
  diffuse += rest.part[size_t(Component::Diffuse)];
  specular += rest.part[size_t(Component::Glossy)];
  if (hidden & LANCER_RAY_DIFFUSE)
    diffuse = glm::vec3(0.0f);
  if (hidden & LANCER_RAY_GLOSSY)
    specular = glm::vec3(0.0f);
  return irradiance * (diffuse * course.diffuse_color + specular * course.specular_color);
}

CourseBranches course_branches(const Bsdf<float> &bsdf) {
  CourseBranches branches;
  float most_reflected = 0.0f, most_refracted = 0.0f;
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe<float> &lobe = bsdf.lobes[i];
    const glm::vec3 &wo = bsdf.wo_local[lobe.frame];
    // From behind its own normal a lobe is not seen.
    if (!(wo.z > 0.0f))
      continue;
    const CourseShares shares = course_shares(lobe, wo.z);
    branches.reflected += shares.reflected;
    branches.refracted += shares.refracted;
    if (mean(shares.reflected) > most_reflected) {
      most_reflected = mean(shares.reflected);
      branches.mirrored = bsdf.frames[lobe.frame].to_world(reflect_local(wo));
    }
    if (mean(shares.refracted) > most_refracted) {
      most_refracted = mean(shares.refracted);
      branches.through = refracted(bsdf, lobe, wo.z);
    }
  }
  return branches;
}

} // namespace lancer
