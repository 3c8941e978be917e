#include "render/pass.h"

#include <cstddef>
#include <type_traits>

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

#define LANCER_PLACE(member) uint32_t(offsetof(SampleResult, member) / sizeof(float))
uint32_t place_in_sample(Pass pass) {
  static_assert(std::is_standard_layout_v<SampleResult> && alignof(SampleResult) == alignof(float));
  switch (pass) {
  case Pass::Combined:
    return LANCER_PLACE(radiance);
  case Pass::Depth:
    return LANCER_PLACE(depth);
  case Pass::Normal:
    return LANCER_PLACE(normal);
  case Pass::Albedo:
    return LANCER_PLACE(albedo);
  case Pass::Position:
    return LANCER_PLACE(position);
  case Pass::ObjectIndex:
    return LANCER_PLACE(object_index);
  case Pass::MaterialIndex:
    return LANCER_PLACE(material_index);
  case Pass::Uv:
    return LANCER_PLACE(uv);
  case Pass::Mist:
    return LANCER_PLACE(mist);
  case Pass::DenoisingNormal:
    return LANCER_PLACE(denoising_normal);
  case Pass::DenoisingDepth:
    return LANCER_PLACE(denoising_depth);
  default:
    return LANCER_PLACE(light) + 3 * (uint32_t(pass) - uint32_t(Pass::Emission));
  }
}
#undef LANCER_PLACE

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
