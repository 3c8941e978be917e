// Evaluation for light samples by lobe shape: only lobes of the requested shapes contribute.
#include <gtest/gtest.h>

#include "bsdf_domain.h"
#include "bsdf_seen.h"
#include "statistics.h"

namespace lancer {
namespace {

using testing::described;
using testing::direction;
using testing::Random;

// Two lobes of two shapes: each alone, and both, which is the sum to the bit.
void expect_the_sum(const LobeInputs<float> &first, LobeShape shape, const LobeInputs<float> &second, LobeShape other) {
  Random random(6);
  int seen = 0;
  for (int k = 0; k < 2000; ++k) {
    const glm::vec3 wo = direction(2.0 * random.uniform() - 1.0, 1.0), wi = direction(2.0 * random.uniform() - 1.0, 4.0);
    const Bsdf<float> both = testing::seen({first, second}, wo);
    const BsdfValue<float> a = both.eval_lit(wi, shape_bit(shape)), b = both.eval_lit(wi, shape_bit(other)),
                           all = both.eval_lit(wi);
    ASSERT_EQ(a.f(), testing::seen({first}, wo).eval_lit(wi).f());
    ASSERT_EQ(b.f(), testing::seen({second}, wo).eval_lit(wi).f());
    for (int part = 0; part < 3; ++part)
      ASSERT_EQ(all.part[part], a.part[part] + b.part[part]);
    ASSERT_EQ(all.pdf, a.pdf + b.pdf);
    ASSERT_EQ(both.eval_lit(wi, kAllShapes).f(), all.f());
    const BsdfValue<float> neither = both.eval_lit(wi, kAllShapes & ~shape_bit(shape) & ~shape_bit(other));
    ASSERT_EQ(neither.f(), glm::vec3(0.0f));
    ASSERT_EQ(neither.pdf, 0.0f);
    seen += a.pdf > 0.0f && b.pdf > 0.0f;
  }
  EXPECT_GT(seen, 200);
}

LobeInputs<float> blenders(LobeKind kind, Facets facets, float roughness) {
  LobeInputs<float> inputs = described(kind, roughness);
  inputs.distribution = facets;
  return inputs;
}

TEST(BsdfShapes, OfTheCourse) {
  expect_the_sum(described(LobeKind::Beckmann, 0.6f), LobeShape::Beckmann,
                 described(LobeKind::Lambert, 0, 1, 0, {0.3f, 0.2f, 0.1f}), LobeShape::Lambert);
}

TEST(BsdfShapes, OfBlender) {
  expect_the_sum(blenders(LobeKind::Glass, Facets::MultiGgx, 0.7f), LobeShape::Microfacet, described(LobeKind::Diffuse, 0.4f),
                 LobeShape::Matte);
}

} // namespace
} // namespace lancer
