// Building many lights ends soon after it is cancelled.
#include "geometry_lab.h"
#include "lights/emission.h"
#include "lights/light_set.h"

#include <atomic>
#include <gtest/gtest.h>

namespace lancer {
namespace {

const std::atomic<bool> kCancel{true};
const BuildContext kCancelled{.cancel = &kCancel};

TEST(Lights, ManyLampsCanBeCancelled) {
  Light lamp;
  lamp.emission = glm::dvec3(1.0);
  std::vector<Light> lights(5, lamp); // more than are sampled one by one
  for (size_t i = 0; i < lights.size(); ++i)
    lights[i].position.x = double(i);
  EXPECT_FALSE(LightSet(lights, {}, 0, Environment()).wide_tree().empty());
  EXPECT_THROW(LightSet(lights, {}, 0, Environment(), kCancelled), BuildCancelled);
}

TEST(Lights, AMeshOfManyFacesCanBeCancelled) {
  Geometry geometry;
  geometry.meshes.resize(1);
  geometry.meshes[0].positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  geometry.meshes[0].triangles = {{0, 1, 2}};
  geometry.instances.resize(1);
  geometry.instances[0].slot_count = 1;
  const std::vector<uint32_t> slots{0};
  std::vector<MaterialView> materials(1);
  materials[0].emission.value = glm::vec3(1.0f);
  EmissionAt emission({}, materials);
  EXPECT_FALSE(EmissiveFaces(geometry, slots, materials, 0, false, emission, {}).empty());
  EXPECT_THROW(EmissiveFaces(geometry, slots, materials, 0, false, emission, kCancelled), BuildCancelled);
}

} // namespace
} // namespace lancer
