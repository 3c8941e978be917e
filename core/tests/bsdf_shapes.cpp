// Kernels that know which shapes of lobes occur give the bits of the one that knows nothing.
#include <gtest/gtest.h>

#include "bsdf_domain.h"
#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::described;
using testing::direction;
using testing::Random;

template <uint32_t Shapes> void expect_the_same(const std::vector<LobeInputs> &lobes) {
  Random random(6);
  for (int k = 0; k < 2000; ++k) {
    const Bsdf bsdf = testing::seen(lobes, direction(2.0 * random.uniform() - 1.0, 1.0));
    const glm::vec3 wi = direction(2.0 * random.uniform() - 1.0, 4.0);
    ASSERT_EQ(bsdf.eval<Shapes>(wi).f(), bsdf.eval(wi).f());
    ASSERT_EQ(bsdf.eval<Shapes>(wi).pdf, bsdf.eval(wi).pdf);
    const float u = random.uniform(), x = random.uniform(), y = random.uniform();
    const BsdfSample special = bsdf.sample<Shapes>(u, {x, y}), general = bsdf.sample(u, {x, y});
    ASSERT_EQ(special.wi, general.wi);
    ASSERT_EQ(special.weight, general.weight);
    ASSERT_EQ(special.share[0], general.share[0]);
    ASSERT_EQ(special.share[1], general.share[1]);
    ASSERT_EQ(special.pdf, general.pdf);
    ASSERT_EQ(special.delta, general.delta);
    ASSERT_EQ(special.component, general.component);
  }
}

LobeInputs blenders(LobeKind kind, Facets facets, float roughness) {
  LobeInputs inputs = described(kind, roughness);
  inputs.distribution = facets;
  return inputs;
}

TEST(BsdfShapes, OfTheCourse) {
  expect_the_same<shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Beckmann)>(
      {described(LobeKind::Beckmann, 0.2f), described(LobeKind::Lambert, 0, 1, 0, {0.3f, 0.2f, 0.1f})});
}

TEST(BsdfShapes, OfBlender) {
  expect_the_same<shape_bit(LobeShape::Lambert) | shape_bit(LobeShape::Microfacet) | shape_bit(LobeShape::Matte)>(
      {blenders(LobeKind::Glass, Facets::MultiGgx, 0.5f), described(LobeKind::Lambert, 0.4f),
       described(LobeKind::Diffuse, 0.4f), blenders(LobeKind::Glossy, Facets::Beckmann, 0.0f)});
}

} // namespace
} // namespace lancer
