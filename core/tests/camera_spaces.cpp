// Camera functions for nodes: its space, window and distance, including panoramas.
#include "camera_lab.h"
#include "nodes_lab.h"
#include "roundings.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// Double roundings of three coordinates up to 10, and twenty of directions up to 1.
constexpr double kPlace = double_roundings(5, 10.0);

// Translated and rotated.
Camera camera(CameraKind kind) {
  Camera result =
      lancer_test::camera(kind, {-0.5 * glm::pi<double>(), 0.5 * glm::pi<double>(), -glm::pi<double>(), glm::pi<double>()});
  // Its x, y, z are the world's y, z, x.
  result.to_world.linear = glm::dmat3(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0);
  result.to_world.translation = {3.0, -2.0, 7.0};
  return result;
}

TEST(CameraSpaces, DirectionsAreBlenders) {
  // Right, up and forwards in the camera's own frame.
  const glm::dvec3 right(0, 1, 0), up(0, 0, 1), forwards(-1, 0, 0);
  const auto expect_axes = [&](CameraKind kind, const glm::vec3 &x, const glm::vec3 &y, const glm::vec3 &z) {
    const Camera view = camera(kind);
    expect_near(view.direction_to_camera(right), x, 0.0f);
    expect_near(view.direction_to_camera(up), y, 0.0f);
    expect_near(view.direction_to_camera(forwards), z, 0.0f);
    expect_near(view.to_camera(view.to_world.translation + 2.0 * forwards), 2.0f * z, 0.0f);
  };
  for (const CameraKind kind : {CameraKind::Perspective, CameraKind::Orthographic})
    expect_axes(kind, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  // Panoramas face x with z up, a mirror ball faces -y.
  expect_axes(CameraKind::Equirectangular, {0, -1, 0}, {0, 0, 1}, {1, 0, 0});
  expect_axes(CameraKind::MirrorBall, {1, 0, 0}, {0, 0, 1}, {0, -1, 0});
}

TEST(CameraSpaces, APanoramasWindowAndDistance) {
  const Camera view = camera(CameraKind::Equirectangular);
  const Ray ray = view.ray({50.0, 70.0}, glm::dvec2(0.0));
  const glm::dvec3 p = ray.o + 2.5 * ray.d;
  // The conversion to float removes double's rounding error.
  expect_near(view.to_window(p), {0.25f, 0.7f, 0.0f}, 0.0f);
  EXPECT_NEAR(view.depth(p), 2.5, kPlace);
  EXPECT_EQ(camera(CameraKind::Perspective).depth(view.to_world.translation + glm::dvec3(-2.0, 5.0, 1.0)), 2.0);
}

TEST(CameraSpaces, APanoramasLensStandsByItsFirstAxis) {
  // Its first axis is as close to forwards as the ray allows, for a mirror ball to the right.
  for (const auto &[kind, along] :
       {std::pair(CameraKind::Equirectangular, glm::dvec3(-1, 0, 0)), {CameraKind::MirrorBall, glm::dvec3(0, 1, 0)}}) {
    Camera view = camera(kind);
    view.lens_radius = 0.5;
    view.focal_distance = 3.0;
    const glm::dvec2 raster(130.0, 60.0);
    Camera sharp = view;
    sharp.lens_radius = 0.0;
    const glm::dvec3 d = sharp.ray(raster, glm::dvec2(0.0)).d;
    const glm::dvec3 first = glm::normalize(along - glm::dot(along, d) * d);
    EXPECT_LT(glm::length(view.ray(raster, {1.0, 0.0}).o - view.to_world.translation - 0.5 * first), kPlace);
    // The second axis completes a right-handed frame with the ray; the mirror ball's is inverted.
    const glm::dvec3 second = kind == CameraKind::MirrorBall ? glm::cross(first, d) : glm::cross(d, first);
    EXPECT_LT(glm::length(view.ray(raster, {0.0, 1.0}).o - view.to_world.translation - 0.5 * second), kPlace);
  }
}

} // namespace
} // namespace lancer_test
