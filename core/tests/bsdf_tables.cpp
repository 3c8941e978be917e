// Albedo tables: no argument causes a read outside them.
#include "bsdf/albedo_tables.h"
#include "bsdf/sheen.h"

#include <gtest/gtest.h>
#include <limits>

namespace lancer {
namespace {

TEST(AlbedoTables, AnyQuestionHasAnAnswerWithinThem) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN(), far = std::numeric_limits<float>::infinity();
  for (const float value : {none, -none, far, -far, -1e30f, 1e30f, -1.0f, 2.0f})
    for (const float share : {
             ggx_albedo(value, 0.5f),
             ggx_albedo(0.5f, value),
             ggx_mean_albedo(value),
             glass_albedo(0.5f, 0.5f, value),
             glass_albedo(value, value, 1.5f),
             glass_mean_albedo(value, value),
             dielectric_mix(0.5f, 0.5f, value),
             fifth_power_mix(value, value),
             sheen_fit(value, 0.5f).albedo,
             sheen_fit(0.5f, value).albedo,
         }) {
      EXPECT_GE(share, 0.0f) << value;
      EXPECT_LE(share, 1.0f) << value;
    }
}

} // namespace
} // namespace lancer
