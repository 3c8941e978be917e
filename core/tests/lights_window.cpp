// A world that reads window coordinates of a direction: by the active camera, for its own rays and for all others.
#include "compile/scene.h"
#include "lancer.h"
#include "lights/environment.h"
#include "scene/camera.h"

#include <gtest/gtest.h>
#include <random>

namespace lancer {
namespace {

struct Framed {
  World world;
  Normalisation normalisation{{7.0, -3.0, 11.0}, 64.0};
  Camera camera;
  Environment environment;

  Framed(uint32_t option, CameraKind kind) {
    Node coordinate;
    coordinate.kind = LANCER_NODE_COORDINATE;
    coordinate.option = option;
    world.program.nodes = {coordinate};
    world.radiance.node = 0;
    world.map_resolution = 8;
    world.schedule = world.program.schedule(std::span(&world.radiance, 1));
    environment = Environment(world, normalisation, BuildContext{.threads = 1}, false);
    // At the user's (1, 2, 3), facing +y: the camera's x, y, z are the world's x, z, -y.
    camera.to_world.linear = glm::dmat3(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0);
    camera.to_world.translation = normalisation.to_normalised(glm::dvec3(1.0, 2.0, 3.0));
    camera.kind = kind;
    camera.width = camera.height = 16;
    camera.left = -0.5, camera.right = 1.5, camera.bottom = -1.0, camera.top = 1.0;
    camera.scale_lengths(normalisation.scale);
  }

  glm::vec3 radiance(const glm::dvec3 &wi, const glm::dvec3 *eye = nullptr) const {
    std::vector<glm::vec4> values(1);
    return environment.radiance(wi, values, &camera, eye);
  }
};

// Some float roundings of numbers of order 1.
void expect_near(const glm::vec3 &got, const glm::vec3 &expected) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(got[i], expected[i], 1e-6f) << "component " << i;
}

TEST(EnvironmentWindow, EveryCameraRayFindsItsOwnPixel) {
  for (const CameraKind kind : {CameraKind::Perspective, CameraKind::Orthographic}) {
    const Framed framed(LANCER_COORDINATE_WINDOW, kind);
    for (const glm::dvec2 raster : {glm::dvec2(0.0, 0.0), glm::dvec2(4.0, 12.0), glm::dvec2(16.0, 2.0)}) {
      const Ray ray = framed.camera.ray(raster, glm::dvec2(0.0));
      expect_near(framed.radiance(glm::normalize(ray.d), &ray.o), glm::vec3(raster / 16.0, 0.0));
    }
  }
}

TEST(EnvironmentWindow, OtherRaysOfAParallelCameraAreTakenForPoints) {
  const Framed framed(LANCER_COORDINATE_WINDOW, CameraKind::Orthographic);
  // The user's point (0.6, 0, 0.8) is (-0.4, -2.2) from the axis, in a window from (-0.5, -1) of 2 by 2.
  expect_near(framed.radiance({0.6, 0.0, 0.8}), {0.05f, -0.6f, 0.0f});
}

TEST(EnvironmentWindow, BesideTheCameraIsNoPlace) {
  const Framed framed(LANCER_COORDINATE_WINDOW, CameraKind::Perspective);
  EXPECT_EQ(framed.radiance({1.0, 0.0, 0.0}), glm::vec3(0.0f));
}

TEST(EnvironmentWindow, CameraTurnsDirections) {
  const Framed framed(LANCER_COORDINATE_CAMERA, CameraKind::Perspective);
  expect_near(framed.radiance({0.48, 0.6, 0.64}), {0.48f, 0.64f, 0.6f});
}

TEST(EnvironmentWindow, SamplesShineAsTheirDirectionsDo) {
  for (const CameraKind kind : {CameraKind::Perspective, CameraKind::Orthographic}) {
    const Framed framed(LANCER_COORDINATE_WINDOW, kind);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0.0f, 0x1.fffffep-1f);
    std::vector<glm::vec4> values(1);
    for (int i = 0; i < 100; ++i) {
      const LightSample sample = framed.environment.sample({uniform(random), uniform(random)}, values, &framed.camera, false);
      ASSERT_GT(sample.pdf, 0.0);
      EXPECT_EQ(sample.radiance, framed.radiance(sample.wi));
    }
  }
}

} // namespace
} // namespace lancer
