// What a world's Light Path knows of the ray that sees it, and of the vertex that asks for its light.
#include "picture_lab.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// A white floor under a sky of 1 + Ray Depth, seen from above. Such a sky is sampled evenly, as all directions look alike to
// who is no ray. Sampled as a light it lies one scattering beyond the floor: 2; a ray that meets it counts itself, too: 3. With
// the power heuristic the second takes c^2 / (c^2 + 1 / 16) at the cosine c, of densities c / pi and 1 / (4 pi), so that the
// floor sends 2 + the integral of 2 c c^2 / (c^2 + 1 / 16) from 0 to 1, which is 2 + 1 - ln(17) / 16.
TEST(LightPaths, ASampledSkyLiesOneScatteringBeyond) {
  constexpr uint32_t kPixels = 16, kSamples = 256;
  Studio studio;
  studio.settings.samples = kSamples;
  studio.settings.max_bounces = 1;
  lancer_node nodes[2] = {node(LANCER_NODE_LIGHT_PATH, LANCER_PATH_DEPTH),
                          node(LANCER_NODE_MATH, LANCER_MATH_ADD, {result_of(0), constant(1.0f)})};
  lancer_world world = {};
  world.radiance = result_of(1);
  world.nodes = nodes;
  world.node_count = 2;
  world.map_resolution = 16;
  studio.add(world);
  studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
  studio.look({0, 0, 1}, {0, 0, 0}, kPixels, 1.0);
  studio.render();
  const std::vector<float> picture = studio.read(LANCER_PASS_COMBINED, 4);
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < picture.size(); i += 4) {
    sum += double(picture[i]);
    squares += double(picture[i]) * double(picture[i]);
  }
  // The pixels are independent: five standard errors of their mean.
  constexpr double kCount = double(kPixels) * kPixels;
  const double mean = sum / kCount, error = std::sqrt((squares / kCount - mean * mean) / kCount);
  EXPECT_NEAR(mean, 3.0 - std::log(17.0) / 16.0, 5.0 * error);
  // Fine enough to tell one scattering from none.
  EXPECT_LT(5.0 * error, 0.05);
}

} // namespace
} // namespace lancer_test
