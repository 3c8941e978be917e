#include "render/pass.h"

namespace lancer {

static_assert(uint32_t(LANCER_PASS_EMISSION) + kLightPasses == LANCER_PASS_TRANSMISSION_COLOR + 1);
static_assert(uint32_t(LANCER_PASS_EMISSION) + kLightComponents == LANCER_PASS_DIFFUSE_DIRECT);

uint32_t channels(Pass pass) {
  switch (pass) {
  case Pass::Combined:
    return 4;
  case Pass::Depth:
  case Pass::ObjectIndex:
  case Pass::MaterialIndex:
  case Pass::Mist:
  case Pass::DenoisingDepth:
  case Pass::Error:
    return 1;
  default:
    return 3;
  }
}

bool of_first_sample(Pass pass) {
  return pass == Pass::Depth || pass == Pass::Position || pass == Pass::ObjectIndex || pass == Pass::MaterialIndex;
}

Pass divisor(Pass pass) {
  if (pass < Pass::DiffuseDirect || pass > Pass::TransmissionColor)
    return pass;
  // Three passes for each component, the colour last.
  const uint32_t component = (uint32_t(pass) - uint32_t(Pass::DiffuseDirect)) / 3;
  return static_cast<Pass>(uint32_t(Pass::DiffuseColor) + 3 * component);
}

uint32_t kept_passes(uint32_t passes) {
  passes &= ~bit(Pass::Error);
  uint32_t kept = passes | bit(Pass::Combined);
  for (uint32_t pass = 0; pass < kPassCount; ++pass) {
    if (passes & 1u << pass)
      kept |= bit(divisor(static_cast<Pass>(pass)));
  }
  return kept;
}

template <class Number> void copy_channels(const SampleResult &result, Pass pass, Number *to) {
  const auto put = [&](const glm::vec3 &v) {
    for (int i = 0; i < 3; ++i)
      to[i] = Number(v[i]);
  };
  switch (pass) {
  case Pass::Combined:
    put(result.radiance);
    to[3] = Number(result.alpha);
    return;
  case Pass::Depth:
    to[0] = Number(result.depth);
    return;
  case Pass::Normal:
    return put(result.normal);
  case Pass::Albedo:
    return put(result.albedo);
  case Pass::Position:
    return put(result.position);
  case Pass::ObjectIndex:
    to[0] = Number(result.object_index);
    return;
  case Pass::MaterialIndex:
    to[0] = Number(result.material_index);
    return;
  case Pass::Uv:
    return put(result.uv);
  case Pass::Mist:
    to[0] = Number(result.mist);
    return;
  case Pass::DenoisingNormal:
    return put(result.denoising_normal);
  case Pass::DenoisingDepth:
    to[0] = Number(result.denoising_depth);
    return;
  default:
    put(result.light[uint32_t(pass) - uint32_t(Pass::Emission)]);
  }
}
template void copy_channels(const SampleResult &result, Pass pass, float *to);
template void copy_channels(const SampleResult &result, Pass pass, double *to);

glm::dvec3 divide_by_color(const glm::dvec3 &light, const glm::dvec3 &color) {
  glm::dvec3 quotient(0.0);
  double sum = 0.0;
  int colored = 0;
  for (int i = 0; i < 3; ++i) {
    if (color[i] == 0.0)
      continue;
    quotient[i] = light[i] / color[i];
    sum += quotient[i];
    ++colored;
  }
  for (int i = 0; i < 3 && colored > 0; ++i) {
    if (color[i] == 0.0)
      quotient[i] = sum / colored;
  }
  return quotient;
}

} // namespace lancer
