// Pictures under many lamps: as bright as the sum over all, and the same at every scale.
#include "picture_lab.h"
#include "statistics.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

// Level of a floor of albedo 0.8 at its centre under point lamps of unequal power.
struct ManyLamps {
  std::vector<lancer_light> lights;
  double level = 0.0;

  explicit ManyLamps(double scale) {
    lancer::testing::Random random(9);
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 p(20.0 * random.uniform() - 10.0, 20.0 * random.uniform() - 10.0, 0.1 + 3.0 * random.uniform());
      const float intensity = std::pow(10.0f, 3.0f * random.uniform() - 1.0f);
      lancer_light light = point_light();
      place(light.matrix, scale * p.x, scale * p.y, scale * p.z);
      light.radius = 0.0f;
      std::fill(light.emission, light.emission + 3, float(scale * scale) * intensity);
      lights.push_back(light);
      level += 0.8 * glm::one_over_pi<double>() * double(intensity) * p.z / std::pow(glm::length(p), 3.0);
    }
  }

  std::vector<float> picture(double scale) const {
    Studio studio;
    studio.settings.samples = 16;
    studio.look({0, 0, 50 * scale}, {0, 0, 0}, 32, 1e-4 * scale);
    studio.camera.clip_end = 100 * scale;
    studio.place(LANCER_SPHERE, studio.add({lobe(LANCER_LAMBERT, 0.8f)}),
                 moved(0, 0, -0.25 * scale) * glm::scale(glm::dmat4(1.0), glm::dvec3(0.25 * scale)));
    for (const lancer_light &light : lights)
      studio.add(light);
    studio.render();
    return studio.read(LANCER_PASS_COMBINED, 4);
  }
};

TEST(LightTree, LightsAsTheSumOverAllLamps) {
  const ManyLamps lamps(1.0);
  const std::vector<float> pixels = lamps.picture(1.0);
  double sum = 0.0, squares = 0.0;
  const double count = double(pixels.size() / 4);
  for (size_t i = 0; i < pixels.size(); i += 4) {
    sum += double(pixels[i]);
    squares += double(pixels[i]) * double(pixels[i]);
  }
  const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / (count - 1.0));
  // Two-sided at the suite's level; the view is 1e-4 wide, over which the level changes by less than this share.
  EXPECT_GT(lancer::testing::normal_p_value((mean - lamps.level) / (error + 1e-4 * lamps.level)),
            lancer::testing::kSignificance);
}

TEST(LightTree, ChoosesAlikeAtEveryScale) {
  const std::vector<float> pixels = ManyLamps(1.0).picture(1.0);
  for (const double scale : {0x1p-20, 0x1p20})
    EXPECT_EQ(ManyLamps(scale).picture(scale), pixels);
}

} // namespace
} // namespace lancer_test
