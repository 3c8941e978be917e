// Panoramas against closed forms and their own inverses, and the shape of an aperture with blades.
#include "scene/camera.h"

#include "camera_lab.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>
#include <random>

namespace lancer_test {
namespace {

using namespace lancer;

constexpr double kPiD = glm::pi<double>();

const std::vector<Camera> &panoramas() {
  static const std::vector<Camera> all = {
      camera(CameraKind::Equirectangular, {-0.5 * kPiD, 0.5 * kPiD, -kPiD, kPiD}),
      camera(CameraKind::Equirectangular, {-0.3, 1.1, -2.0, 0.5}),
      camera(CameraKind::FisheyeEquidistant, {kPiD}),
      camera(CameraKind::FisheyeEquidistant, {1.7 * kPiD}),
      camera(CameraKind::FisheyeEquisolid, {10.5, kPiD, 36.0, 24.0}),
      camera(CameraKind::FisheyePolynomial, {kPiD, 36.0, 24.0, -1.1735143712967577e-05, -0.019988736953434998,
                                             -3.3525322965709175e-06, 3.099275275886036e-06, -2.6064646454854524e-08}),
      camera(CameraKind::MirrorBall, {}),
      camera(CameraKind::Cylindrical, {-kPiD, kPiD, -1.0, 1.0, 1.0}),
      camera(CameraKind::Cylindrical, {-1.0, 2.0, -0.5, 3.0, 2.0}),
  };
  return all;
}

TEST(Panorama, PlaceUndoesDirection) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const Camera &view : panoramas()) {
    int shown = 0;
    for (int i = 0; i < 1000; ++i) {
      const glm::dvec2 place(uniform(random), uniform(random));
      const glm::dvec3 d = panorama_direction(view, place);
      if (d == glm::dvec3(0.0))
        continue;
      ++shown;
      // A dozen roundings of 2^-53 of angles below 7 and radii below 22 mm, relative to them: at most 1e-14. At a ball's rim
      // they grow by 1 over the depth squared, which is uniform in 0 ... 1 over its disk: beyond 1e-5 in all but one of a
      // hundred such samples.
      EXPECT_NEAR(glm::length(d), 1.0, 1e-14);
      EXPECT_LT(glm::length(panorama_place(view, d) - place), 1e-9) << int(view.kind);
    }
    EXPECT_GT(shown, 500) << int(view.kind);
  }
}

TEST(Panorama, TheMiddleLooksForward) {
  for (const Camera &view : panoramas()) {
    if (view.kind == CameraKind::Equirectangular && view.panorama[3] != kPiD)
      continue;
    if (view.kind == CameraKind::Cylindrical && view.panorama[4] != 1.0)
      continue;
    // The polynomial lens deviates by its k0, 1.17e-5 radians; the others by roundings.
    EXPECT_LT(glm::length(panorama_direction(view, glm::dvec2(0.5)) - glm::dvec3(0.0, 0.0, -1.0)), 2e-5) << int(view.kind);
    // Right is right and up is up.
    EXPECT_GT(panorama_direction(view, {0.55, 0.5}).x, 0.0) << int(view.kind);
    EXPECT_GT(panorama_direction(view, {0.5, 0.55}).y, 0.0) << int(view.kind);
  }
}

TEST(Panorama, AnglesAreThoseOfTheProjection) {
  // An equidistant fisheye of half a turn: the angle from the axis grows linearly to a quarter turn at the rim.
  const glm::dvec3 side = panorama_direction(panoramas()[2], {1.0, 0.5});
  EXPECT_NEAR(side.x, 1.0, 1e-15);
  const glm::dvec3 half = panorama_direction(panoramas()[2], {0.5, 0.75});
  EXPECT_NEAR(half.y, std::sqrt(0.5), 1e-15);
  // Equisolid: r = 2 f sin(theta / 2).
  const glm::dvec3 solid = panorama_direction(panoramas()[4], {0.5 + 5.0 / 36.0, 0.5});
  EXPECT_NEAR(std::atan2(solid.x, -solid.z), 2.0 * std::asin(5.0 / 21.0), 1e-14);
  // The mirror ball's rim shows the direction behind it.
  const glm::dvec3 rim = panorama_direction(panoramas()[6], {1.0, 0.5});
  EXPECT_NEAR(rim.z, 1.0, 1e-15);
}

TEST(Panorama, NothingIsShownBeyondTheLens) {
  const Camera &fisheye = panoramas()[2];
  EXPECT_LT(fisheye.ray({1.0, 1.0}, glm::dvec2(0.0)).tmax, 0.0);
  EXPECT_GT(fisheye.ray({100.0, 50.0}, glm::dvec2(0.0)).tmax, 0.0);
  EXPECT_LT(panoramas()[6].ray({1.0, 1.0}, glm::dvec2(0.0)).tmax, 0.0);
  EXPECT_LT(panoramas()[4].ray({0.0, 0.0}, glm::dvec2(0.0)).tmax, 0.0);
}

TEST(Panorama, TheLensAimsAtOnePoint) {
  for (Camera view : panoramas()) {
    view.lens_radius = 0.2;
    view.focal_distance = 3.0;
    view.to_world.translation = {1.0, 2.0, 3.0};
    const glm::dvec2 raster(120.0, 45.0);
    const Ray middle = view.ray(raster, glm::dvec2(0.0));
    const glm::dvec3 focus = middle.o + 3.0 * middle.d;
    for (const glm::dvec2 &lens : {glm::dvec2(1.0, 0.0), glm::dvec2(-0.3, 0.8)}) {
      const Ray ray = view.ray(raster, lens);
      EXPECT_NEAR(glm::length(ray.o - middle.o), 0.2 * glm::length(lens), 1e-14);
      EXPECT_NEAR(glm::dot(ray.o - middle.o, middle.d), 0.0, 1e-14);
      // Both lines meet at the point in focus.
      EXPECT_LT(glm::length(glm::cross(focus - ray.o, ray.d)), 1e-14);
    }
  }
}

TEST(Lens, BladesFillAPolygonEvenly) {
  Camera view;
  view.aperture_blades = 5;
  view.aperture_rotation = 0.3;
  const int side = 400;
  const double inner = std::cos(kPiD / 5.0), area = 2.5 * std::sin(2.0 * kPiD / 5.0);
  double inside = 0.0;
  glm::dvec2 sum(0.0);
  for (int i = 0; i < side * side; ++i) {
    const glm::dvec2 p = view.aperture({(float(i % side) + 0.5f) / float(side), (float(i / side) + 0.5f) / float(side)});
    sum += p;
    // Inside the sides: the distance along the normal of every side is at most the inner radius, except for some roundings.
    for (int k = 0; k < 5; ++k) {
      const double turn = 0.3 + 2.0 * kPiD * k / 5.0;
      EXPECT_LE(p.x * std::cos(turn) + p.y * std::sin(turn), inner + 0x1p-49);
    }
    inside += glm::length(p) <= 0.5 ? 1.0 : 0.0;
  }
  // The inner disk's share of the area. In each blade its rim crosses all 400 rows of the grid and 10 columns up and down: 2100
  // of 160000 cells are cut. Half of each, all to one side, would be 6.6e-3.
  EXPECT_NEAR(inside / (side * side), 0.25 * kPiD / area, 5e-3);
  // The blades are rotations of each other; u is float, and their places differ by at most five times its rounding of 2^-25.
  EXPECT_LT(glm::length(sum) / (side * side), 5 * 0x1p-24);
}

TEST(Lens, TheRatioNarrowsIt) {
  for (const uint32_t blades : {0u, 6u}) {
    Camera view;
    view.aperture_blades = blades;
    view.aperture_ratio = 2.0;
    glm::dvec2 largest(0.0);
    for (int i = 0; i < 100 * 100; ++i)
      largest =
          glm::max(largest, glm::abs(view.aperture({(float(i % 100) + 0.5f) / 100.0f, (float(i / 100) + 0.5f) / 100.0f})));
    // The rim of a disk is 1 except for a few float roundings. A hexagon's sides are to the right, cos(30 degrees) away, its
    // corner above; steps of 6 hundredths of a blade in the radius squared fall short of both by 3 %.
    EXPECT_LE(largest.x, 0.5 + 1e-6);
    EXPECT_GT(largest.x, 0.4);
    EXPECT_GT(largest.y, 0.8);
  }
}

TEST(Camera, WindowUndoesRay) {
  Camera view;
  view.width = 80;
  view.height = 40;
  view.left = -0.3;
  view.right = 0.5;
  view.bottom = -0.2;
  view.top = 0.2;
  view.to_world.translation = {3.0, -2.0, 7.0};
  view.to_world.linear = glm::dmat3(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0);
  for (const CameraKind kind : {CameraKind::Perspective, CameraKind::Orthographic}) {
    view.kind = kind;
    const Ray ray = view.ray({20.0, 30.0}, glm::dvec2(0.0));
    const glm::dvec3 p = ray.o + 2.5 * ray.d;
    const glm::vec3 place = view.to_window(p);
    // One rounding to float, which has 2^-24 for numbers below 1, and 2^-22 below 4.
    EXPECT_NEAR(place.x, 0.25, 0x1p-24);
    EXPECT_NEAR(place.y, 0.75, 0x1p-24);
    EXPECT_NEAR(view.to_camera(p).z, 2.5, 0x1p-22);
    // Differences and products of coordinates below 10, in double: ten roundings of 2^-53 relative to 10.
    EXPECT_NEAR(view.depth(p), 2.5, 1e-14);
  }
}

} // namespace
} // namespace lancer_test
