// Camera rays: flat projections, panoramas and lenses.
#include "scene/camera.h"

#include "sampling/elementary.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lancer {

namespace {

// Returns a direction at the angle theta from the axis; across: its azimuth, as a vector of any length.
glm::dvec3 off_axis(double theta, const glm::dvec2 &across) {
  const double length = glm::length(across);
  const glm::dvec2 unit = length > 0.0 ? across / length : glm::dvec2(1.0, 0.0);
  return {unit.x * sin(theta), unit.y * sin(theta), -cos(theta)};
}

// Returns the angle from the axis at r mm from the centre of a polynomial lens; a negative angle flips the picture.
double polynomial_angle(const Camera &camera, double r) {
  const auto &k = camera.panorama;
  return -(k[3] + r * (k[4] + r * (k[5] + r * (k[6] + r * k[7]))));
}

// Returns the radius in mm at which a polynomial lens shows an angle, by Newton's method.
double polynomial_radius(const Camera &camera, double theta) {
  const auto &k = camera.panorama;
  double r = (-theta - k[3]) / k[4];
  for (int step = 0; step < 20; ++step) {
    const double slope = -(k[4] + r * (2.0 * k[5] + r * (3.0 * k[6] + r * 4.0 * k[7])));
    const double next = r + (theta - polynomial_angle(camera, r)) / slope;
    if (next == r)
      break;
    r = next;
  }
  return r;
}

// Returns the place on a sensor at radius r in the azimuth of a direction.
glm::dvec2 on_sensor(const glm::dvec3 &d, double r, double width, double height) {
  const double across = hypot(d.x, d.y);
  const glm::dvec2 unit = across > 0.0 ? glm::dvec2(d.x, d.y) / across : glm::dvec2(0.0);
  return {r * unit.x / width + 0.5, r * unit.y / height + 0.5};
}

} // namespace

glm::dvec3 panorama_direction(const Camera &camera, const glm::dvec2 &place) {
  const auto &p = camera.panorama;
  const glm::dvec2 middle = place - 0.5;
  switch (camera.kind) {
  case CameraKind::Equirectangular: {
    const double latitude = glm::mix(p[0], p[1], place.y), longitude = glm::mix(p[2], p[3], place.x);
    return {cos(latitude) * sin(longitude), sin(latitude), -cos(latitude) * cos(longitude)};
  }
  case CameraKind::FisheyeEquidistant: {
    const double r = 2.0 * glm::length(middle);
    return r > 1.0 ? glm::dvec3(0.0) : off_axis(0.5 * r * p[0], middle);
  }
  case CameraKind::FisheyeEquisolid: {
    const glm::dvec2 sensor = middle * glm::dvec2(p[2], p[3]);
    const double r = glm::length(sensor), lens = p[0];
    if (r > 2.0 * lens * sin(0.25 * p[1]) || r > 2.0 * lens)
      return glm::dvec3(0.0);
    return off_axis(2.0 * asin(r / (2.0 * lens)), sensor);
  }
  case CameraKind::FisheyePolynomial: {
    const glm::dvec2 sensor = middle * glm::dvec2(p[1], p[2]);
    const double theta = polynomial_angle(camera, glm::length(sensor));
    return std::abs(theta) > 0.5 * p[0] ? glm::dvec3(0.0) : off_axis(theta, sensor);
  }
  case CameraKind::MirrorBall: {
    // The mirror ball is seen from infinity. The normal at a place of the ball halves the angle between the viewer and the
    // mirrored direction.
    const glm::dvec2 at = 2.0 * middle;
    const double depth2 = 1.0 - glm::dot(at, at);
    if (depth2 < 0.0)
      return glm::dvec3(0.0);
    const double n = std::sqrt(depth2);
    return {2.0 * n * at.x, 2.0 * n * at.y, 1.0 - 2.0 * depth2};
  }
  case CameraKind::Cylindrical: {
    const double longitude = glm::mix(p[0], p[1], place.x), height = glm::mix(p[2], p[3], place.y) / p[4];
    return glm::normalize(glm::dvec3(sin(longitude), height, -cos(longitude)));
  }
  case CameraKind::Perspective:
  case CameraKind::Orthographic:
    break;
  }
  return {0.0, 0.0, -1.0};
}

glm::dvec2 panorama_place(const Camera &camera, const glm::dvec3 &d) {
  const auto &p = camera.panorama;
  const double theta = atan2(hypot(d.x, d.y), -d.z), longitude = atan2(d.x, -d.z);
  switch (camera.kind) {
  case CameraKind::Equirectangular: {
    const double latitude = atan2(d.y, hypot(d.x, d.z));
    return {(longitude - p[2]) / (p[3] - p[2]), (latitude - p[0]) / (p[1] - p[0])};
  }
  case CameraKind::FisheyeEquidistant:
    return on_sensor(d, theta / p[0], 1.0, 1.0);
  case CameraKind::FisheyeEquisolid:
    return on_sensor(d, 2.0 * p[0] * sin(0.5 * theta), p[2], p[3]);
  case CameraKind::FisheyePolynomial:
    return on_sensor(d, polynomial_radius(camera, theta), p[1], p[2]);
  case CameraKind::MirrorBall: {
    // The normal is halfway between the direction and the viewer.
    const double scale = 0.5 / std::sqrt(std::max(0.5 * (1.0 - d.z), std::numeric_limits<double>::min()));
    return {0.5 * (d.x * scale + 1.0), 0.5 * (d.y * scale + 1.0)};
  }
  case CameraKind::Cylindrical: {
    const double height = d.y / hypot(d.x, d.z) * p[4];
    return {(longitude - p[0]) / (p[1] - p[0]), (height - p[2]) / (p[3] - p[2])};
  }
  case CameraKind::Perspective:
  case CameraKind::Orthographic:
    break;
  }
  return glm::dvec2(0.5);
}

void Camera::scale_lengths(double scale) {
  clip_start *= scale;
  clip_end *= scale;
  lens_radius *= scale;
  focal_distance *= scale;
  eye_offset *= scale;
  convergence *= scale;
  if (kind == CameraKind::Orthographic) {
    left *= scale;
    right *= scale;
    bottom *= scale;
    top *= scale;
  }
}

Ray Camera::ray(const glm::dvec2 &raster, const glm::dvec2 &lens) const {
  Ray ray;
  ray.tmin = clip_start;
  ray.tmax = clip_end;
  if (!is_panorama()) {
    const RayLanes<float> flat = flat_ray<float>(*this, {raster.x, raster.y}, {lens.x, lens.y});
    ray.o = flat.o;
    ray.d = flat.d;
    if (is_stereo())
      move_to_eye({0.0, 0.0, 1.0}, ray.o, ray.d);
    return ray;
  }
  const glm::dvec2 place(left + (right - left) * raster.x / width, bottom + (top - bottom) * raster.y / height);
  glm::dvec3 o(0.0), d = panorama_direction(*this, place);
  if (d == glm::dvec3(0.0)) {
    ray.o = to_world.translation;
    ray.tmax = -1.0;
    return ray;
  }
  if (lens_radius > 0.0) {
    // The lens is perpendicular to this direction, its first axis as close to forwards as possible. The lens of a mirror ball
    // has its first axis close to the right, and its second axis inverted.
    const bool ball = kind == CameraKind::MirrorBall;
    const glm::dvec3 along = ball ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, -1.0),
                     across = along - glm::dot(along, d) * d;
    const glm::dvec3 u = glm::dot(across, across) > 0.0 ? glm::normalize(across) : glm::dvec3(0.0, 1.0, 0.0);
    o = lens_radius * (lens.x * u + lens.y * (ball ? glm::cross(u, d) : glm::cross(d, u)));
    d = glm::normalize(focal_distance * d - o);
  }
  if (is_stereo())
    move_to_eye({0.0, 1.0, 0.0}, o, d);
  ray.o = to_world.point(o);
  ray.d = to_world.vector(d);
  return ray;
}

void Camera::move_to_eye(const glm::dvec3 &up, glm::dvec3 &o, glm::dvec3 &d) const {
  const double length = glm::length(d);
  const glm::dvec3 unit = d / length, across = glm::cross(unit, up);
  // A ray along the axis has no side: its eye is in the middle.
  if (!(glm::dot(across, across) > 0.0))
    return;
  double offset = eye_offset;
  if (pole_merge_to > 0.0) {
    const double altitude = std::abs(asin(std::clamp(glm::dot(unit, up), -1.0, 1.0)));
    if (altitude > pole_merge_to)
      offset = 0.0;
    else if (altitude > pole_merge_from)
      offset *= cos(glm::half_pi<double>() * (altitude - pole_merge_from) / (pole_merge_to - pole_merge_from));
  }
  const glm::dvec3 moved = offset * glm::normalize(across);
  o += moved;
  if (convergence > 0.0)
    d = length * glm::normalize(convergence * unit - moved);
}

glm::dvec2 Camera::aperture(const glm::vec2 &u) const {
  if (aperture_blades < 3)
    return round_aperture(*this, u.x, u.y);
  // Sample one of the triangles around the centre, and a point of it.
  const double scaled = double(u.x) * aperture_blades, blade = std::floor(scaled);
  const double across = std::sqrt(scaled - blade), along = double(u.y) * across;
  const double half = glm::pi<double>() / aperture_blades;
  // The corners of the triangle: the centre, and the rim at half a blade to either side.
  const glm::dvec2 p(across * cos(half), (2.0 * along - across) * sin(half));
  const double turn = aperture_rotation + 2.0 * half * blade, c = cos(turn), s = sin(turn);
  return {(c * p.x - s * p.y) / aperture_ratio, s * p.x + c * p.y};
}

double Camera::depth(const glm::dvec3 &p) const {
  const glm::dvec3 v = p - to_world.translation;
  return is_panorama() ? glm::length(v) : -glm::dot(v, to_world.linear[2]);
}

glm::vec3 Camera::direction_to_camera(const glm::dvec3 &d) const {
  const glm::dvec3 local = to_local(d);
  if (!is_panorama())
    return glm::vec3(local.x, local.y, -local.z);
  // Blender's panoramas face +x with z up; those of a mirror ball face -y.
  return kind == CameraKind::MirrorBall ? glm::vec3(local.x, local.z, local.y) : glm::vec3(-local.z, -local.x, local.y);
}

glm::dvec3 Camera::direction_from_camera(const glm::dvec3 &d) const {
  if (!is_panorama())
    return to_world.linear * glm::dvec3(d.x, d.y, -d.z);
  return to_world.linear * (kind == CameraKind::MirrorBall ? glm::dvec3(d.x, d.z, d.y) : glm::dvec3(-d.y, d.z, -d.x));
}

glm::vec3 Camera::to_camera(const glm::dvec3 &p) const { return direction_to_camera(p - to_world.translation); }

glm::vec3 Camera::to_window(const glm::dvec3 &p) const {
  return glm::vec3(glm::dvec3(window_place(to_local(p - to_world.translation)), 0.0));
}

glm::dvec2 Camera::window_place(const glm::dvec3 &local) const {
  glm::dvec2 place(local);
  if (kind == CameraKind::Perspective)
    place = glm::dvec2(local) / -local.z;
  else if (is_panorama())
    place = panorama_place(*this, glm::normalize(local));
  return {(place.x - left) / (right - left), (place.y - bottom) / (top - bottom)};
}

namespace {

// Returns the mean change of a ray's unit direction over a pixel to its right and one above it.
double change_over_pixel(const glm::dvec3 &here, const glm::dvec3 &right, const glm::dvec3 &above) {
  const glm::dvec3 d = glm::normalize(here);
  return 0.5 * (glm::length(glm::normalize(right) - d) + glm::length(glm::normalize(above) - d));
}

} // namespace

PixelCone::PixelCone(const Camera &camera) {
  // Compare the rays through the middle of the picture and through the neighbouring pixels.
  const glm::dvec2 middle(0.5 * camera.width, 0.5 * camera.height);
  const Ray here = camera.ray(middle, glm::dvec2(0.0));
  const Ray right = camera.ray(middle + glm::dvec2(1.0, 0.0), glm::dvec2(0.0));
  const Ray above = camera.ray(middle + glm::dvec2(0.0, 1.0), glm::dvec2(0.0));
  base = 0.5 * (glm::length(right.o - here.o) + glm::length(above.o - here.o));
  spread = change_over_pixel(here.d, right.d, above.d);
}

namespace {

// Returns the mean change of a perspective camera's unit direction over a pixel to the right and one above, from a place at
// depth 1 in the camera's frame: the derivative half a pixel further, which errs by the square of a pixel's size.
double change_at(const Camera &camera, const glm::dvec2 &at) {
  const double right = (camera.right - camera.left) / camera.width, above = (camera.top - camera.bottom) / camera.height;
  const double x = at.x + 0.5 * right, y = at.y + 0.5 * above, x2 = 1.0 + at.x * at.x, y2 = 1.0 + at.y * at.y;
  return 0.5 * (std::abs(right) * std::sqrt(y2) / (x * x + y2) + std::abs(above) * std::sqrt(x2) / (x2 + y * y));
}
double change_at_middle(const Camera &camera) {
  return change_at(camera, {0.5 * (camera.left + camera.right), 0.5 * (camera.bottom + camera.top)});
}

// Returns the change in a direction of the camera's frame over that at the middle; 1 for other cameras and behind the camera.
double relative_change(const Camera &camera, const glm::dvec3 &local, double at_middle) {
  const bool varies = camera.kind == CameraKind::Perspective && local.z < 0.0;
  return varies ? change_at(camera, glm::dvec2(local) / -local.z) / at_middle : 1.0;
}

} // namespace

double relative_spread(const Camera &camera, const glm::dvec3 &d) {
  return relative_change(camera, camera.to_local(d), change_at_middle(camera));
}

PixelSpread::PixelSpread(const Camera &camera) : camera_(camera) {
  if (camera.is_panorama())
    return;
  of_middle_ = PixelCone(camera).spread;
  relative_to_ = change_at_middle(camera);
}

double PixelSpread::operator()(const glm::dvec3 &d) const {
  const glm::dvec3 local = camera_.to_local(d);
  if (!camera_.is_panorama())
    return of_middle_ * relative_change(camera_, local, relative_to_);
  const glm::dvec3 here = glm::normalize(local);
  const glm::dvec2 place = panorama_place(camera_, here);
  const glm::dvec3 right = panorama_direction(camera_, place + glm::dvec2((camera_.right - camera_.left) / camera_.width, 0.0));
  const glm::dvec3 above =
      panorama_direction(camera_, place + glm::dvec2(0.0, (camera_.top - camera_.bottom) / camera_.height));
  // Beyond the edge of the field of view there is no direction.
  if (right == glm::dvec3(0.0) || above == glm::dvec3(0.0))
    return 0.0;
  return change_over_pixel(here, right, above);
}

} // namespace lancer
