// An area lamp that lies in the plane of a face, as Blender's floats have them: the face hides nothing of it.
#include "lights/area_light.h"
#include "lights/place_light.h"

#include <gtest/gtest.h>
#include <random>

namespace lancer_test {

using namespace lancer;

namespace {

// Turned about x and moved; columns and places are floats, as Blender hands them over.
Affine placed(double angle, const glm::dvec3 &at) {
  Affine map;
  const double c = double(float(std::cos(angle))), s = double(float(std::sin(angle)));
  map.linear = {{1, 0, 0}, {0, c, s}, {0, -s, c}};
  map.translation = glm::dvec3(glm::vec3(at));
  return map;
}

} // namespace

TEST(LightsInFaces, NoFaceOfTheirPlaneIsBeforeThem) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int round = 0; round < 1000; ++round) {
    const double far = std::exp2(std::floor(20.0 * number(random)));
    const Affine map = placed(3.0 * number(random), far * glm::dvec3(number(random), number(random), number(random)));
    LightDescription from;
    from.kind = LightKind::Area;
    from.to_world = map;
    from.size = glm::vec2(float(far * 0.3), float(far * 0.2));
    const Light light = place_light(from, Normalisation{});
    // Corners of a ceiling that has the same placement: floats of its own mesh.
    const glm::dvec3 corner = map.translation + map.linear * glm::dvec3(glm::vec3(far * number(random), far * number(random), 0.0));
    const glm::dvec3 rounded(glm::vec3{corner});
    for (const glm::dvec3 &p : {corner, rounded})
      EXPECT_GT(glm::dot(p - light.position, light.z), 0.0) << far;
    // What that moves it by is nothing that anyone sees.
    EXPECT_LT(glm::length(light.position - map.translation), 2e-6 * far);
  }
}

} // namespace lancer_test
