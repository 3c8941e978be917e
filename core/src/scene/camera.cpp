#include "scene/camera.h"

#include "sampling/elementary.h"
#include "sampling/warp.h"
#include "scene/panorama.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lancer {

void Camera::scale_lengths(double scale) {
  clip_start *= scale;
  clip_end *= scale;
  lens_radius *= scale;
  focal_distance *= scale;
  if (kind == CameraKind::Orthographic) {
    left *= scale;
    right *= scale;
    bottom *= scale;
    top *= scale;
  }
}

Ray Camera::ray(const glm::dvec2 &raster, const glm::dvec2 &lens) const {
  const glm::dvec2 place(left + (right - left) * raster.x / width, bottom + (top - bottom) * raster.y / height);
  Ray ray;
  ray.tmin = clip_start;
  ray.tmax = clip_end;
  glm::dvec3 o(0.0), d(place, -1.0);
  if (kind == CameraKind::Orthographic) {
    o = glm::dvec3(place, 0.0);
    d = glm::dvec3(0.0, 0.0, -1.0);
  } else if (is_panorama()) {
    d = panorama_direction(*this, place);
    if (d == glm::dvec3(0.0)) {
      ray.o = to_world.translation;
      ray.tmax = -1.0;
      return ray;
    }
  }
  if (lens_radius > 0.0 && is_panorama()) {
    // The lens stands across this very direction, its first axis as near as that allows to forwards; a mirror ball's to the
    // right, and the second the other way around.
    const bool ball = kind == CameraKind::MirrorBall;
    const glm::dvec3 along = ball ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, -1.0),
                     across = along - glm::dot(along, d) * d;
    const glm::dvec3 u = glm::dot(across, across) > 0.0 ? glm::normalize(across) : glm::dvec3(0.0, 1.0, 0.0);
    o = lens_radius * (lens.x * u + lens.y * (ball ? glm::cross(u, d) : glm::cross(d, u)));
    d = glm::normalize(focal_distance * d - o);
  } else if (lens_radius > 0.0) {
    // Aim every point of the lens at the same point of the plane in focus.
    const glm::dvec3 shift(lens_radius * lens.x, lens_radius * lens.y, 0.0);
    o += shift;
    d -= shift / focal_distance;
  }
  ray.o = to_world.point(o);
  ray.d = to_world.vector(d);
  return ray;
}

glm::dvec2 Camera::aperture(const glm::vec2 &u) const {
  if (aperture_blades < 3) {
    const glm::dvec2 d(warp_disk(u));
    return {d.x / aperture_ratio, d.y};
  }
  // Choose one of the triangles around the middle, and a point of it.
  const double scaled = double(u.x) * aperture_blades, blade = std::floor(scaled);
  const double across = std::sqrt(scaled - blade), along = double(u.y) * across;
  const double half = glm::pi<double>() / aperture_blades;
  // Its corners: the middle, and the rim at half a blade to either side.
  const glm::dvec2 p(across * cos(half), (2.0 * along - across) * sin(half));
  const double turn = aperture_rotation + 2.0 * half * blade, c = cos(turn), s = sin(turn);
  return {(c * p.x - s * p.y) / aperture_ratio, s * p.x + c * p.y};
}

double Camera::depth(const glm::dvec3 &p) const {
  const glm::dvec3 v = p - to_world.translation;
  return is_panorama() ? glm::length(v) : -glm::dot(v, to_world.linear[2]);
}

glm::vec3 Camera::direction_to_camera(const glm::dvec3 &d) const {
  const glm::dvec3 local = glm::transpose(to_world.linear) * d;
  if (!is_panorama())
    return glm::vec3(local.x, local.y, -local.z);
  // Blender's panoramas look along +x with z up; those of a mirror ball along -y.
  return kind == CameraKind::MirrorBall ? glm::vec3(local.x, local.z, local.y) : glm::vec3(-local.z, -local.x, local.y);
}

glm::vec3 Camera::to_camera(const glm::dvec3 &p) const { return direction_to_camera(p - to_world.translation); }

glm::vec3 Camera::to_window(const glm::dvec3 &p) const {
  const glm::dvec3 local = glm::transpose(to_world.linear) * (p - to_world.translation);
  glm::dvec2 place(local);
  if (kind == CameraKind::Perspective)
    place = glm::dvec2(local) / -local.z;
  else if (is_panorama())
    place = panorama_place(*this, glm::normalize(local));
  return glm::vec3(glm::dvec3((place.x - left) / (right - left), (place.y - bottom) / (top - bottom), 0.0));
}

} // namespace lancer
