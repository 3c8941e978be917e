#include "scene/panorama.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "sampling/elementary.h"

namespace lancer {

namespace {

// A direction at the angle theta from the axis; across: which way, of any length.
glm::dvec3 off_axis(double theta, const glm::dvec2 &across) {
  const double length = glm::length(across);
  const glm::dvec2 unit = length > 0.0 ? across / length : glm::dvec2(1.0, 0.0);
  return {unit.x * sin(theta), unit.y * sin(theta), -cos(theta)};
}

// The angle from the axis that a lens of the polynomial kind gives to a point at r mm from the middle; its sign turns the
// picture around.
double polynomial_angle(const Camera &camera, double r) {
  const auto &k = camera.panorama;
  return -(k[3] + r * (k[4] + r * (k[5] + r * (k[6] + r * k[7]))));
}

// The radius in mm at which a lens of the polynomial kind shows an angle, by Newton's method.
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

// Where the direction across the axis, scaled to length r, lies in a sensor.
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
    // The ball is seen from afar; its normal halves the angle to what it mirrors.
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
    // Half way between the direction and the viewer stands the normal.
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

} // namespace lancer
