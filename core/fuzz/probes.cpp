#include "probes.h"
#include "lancer_probes.h"

#include "checked.h"

namespace lancer_fuzz {

namespace {

constexpr uint32_t kCount = 3; // elements per probe

} // namespace

void probe_camera(lancer_session session, Bytes &bytes) {
  const double raster[2 * kCount] = {0.5, 0.5, -1e9, 3.0, double(bytes.number(1.0f, 0.0f, 8.0f)), 2.0},
                          lens[2 * kCount] = {0.5, 0.5, 0.0, 0.0, 0.99999, 0.5};
  double origins[3 * kCount], directions[3 * kCount];
  LANCER_CHECKED(lancer_probe_camera(session, kCount, raster, lens, origins, directions));
}

void probe_scene(lancer_scene scene, const Filled *filled, Bytes &bytes) {
  double origins[3 * kCount], directions[3 * kCount], low[kCount], high[kCount];
  float u[3 * kCount], wo[3 * kCount], wi[3 * kCount];
  for (uint32_t i = 0; i < 3 * kCount; ++i) {
    origins[i] = bytes.number(i % 3 == 2 ? 6.0 : 0.0, -3.0, 3.0);
    directions[i] = bytes.number(i % 3 == 2 ? -1.0 : 0.0, -1.0, 1.0);
    u[i] = bytes.number(0.5f, 0.0f, 0.999f);
    wo[i] = bytes.number(i % 3 == 2 ? 0.8f : i % 3 == 0 ? 0.6f : 0.0f, -1.0f, 1.0f);
    wi[i] = bytes.number(i % 3 == 2 ? 0.6f : i % 3 == 0 ? 0.8f : 0.0f, -1.0f, 1.0f);
  }
  for (uint32_t i = 0; i < kCount; ++i) {
    low[i] = bytes.number(0.0, 0.0, 4.0);
    high[i] = bytes.number(1e30, 0.0, 10.0);
  }
  const uint32_t material = bytes.reference(filled ? filled->materials : 0),
                 light = bytes.reference(filled ? filled->lights + 1 : 0);
  lancer_hit hits[kCount];
  uint8_t occluded[kCount];
  uint64_t counts[4];
  float four[4 * kCount], three[3 * kCount], pdf[kCount];
  lancer_bsdf_sample samples[kCount];
  lancer_light_sample light_samples[kCount];
  lancer_lobe_info lobes[4];
  uint32_t lobe_count = 0;
  LANCER_CHECKED(lancer_probe_intersect(scene, kCount, origins, directions, low, high, hits));
  LANCER_CHECKED(lancer_probe_occluded(scene, kCount, origins, directions, low, high, occluded));
  LANCER_CHECKED(lancer_probe_traversal(scene, kCount, origins, directions, low, high, bytes.below(2), counts));
  LANCER_CHECKED(lancer_probe_bsdf(scene, material, kCount, wo, wi, three, pdf));
  LANCER_CHECKED(lancer_probe_bsdf_sample(scene, material, kCount, wo, u, samples));
  LANCER_CHECKED(lancer_probe_lobes(scene, material, wo, lobes, bytes.below(5), &lobe_count, three, nullptr));
  LANCER_CHECKED(lancer_probe_node(scene, material, bytes.below(8), kCount, u, four));
  LANCER_CHECKED(lancer_probe_world(scene, kCount, directions, three, pdf));
  LANCER_CHECKED(lancer_probe_light(scene, light, kCount, origins, u, light_samples));
  LANCER_CHECKED(lancer_probe_light_pdf(scene, light, kCount, origins, directions, pdf));
}

void probe_nothing(Bytes &bytes) {
  float a[kCount], b[kCount], c[kCount], numbers[8];
  for (uint32_t i = 0; i < kCount; ++i)
    a[i] = bytes.number(0.5f, 0.0f, 1.0f);
  LANCER_CHECKED(lancer_probe_microfacet(kCount, a, a, a, a, a, b, c, numbers));
  const uint32_t seed = bytes.byte(), x = bytes.word(), y = bytes.byte(), sample = bytes.word();
  LANCER_CHECKED(lancer_probe_sampler(seed, x, y, sample, 8, numbers));
  const uint32_t filter = bytes.choice(2);
  LANCER_CHECKED(lancer_probe_filter(filter, bytes.number(1.5f, 0.0f, 4.0f), kCount, a, b));
  lancer_sizeof(bytes.byte());
}

} // namespace lancer_fuzz
