// Cloth by multiple scattering in a layer of microfibres (Zeltner, Burley, Chiang 2022): a linearly transformed cosine whose
// two coefficients and albedo follow wo and the roughness, linearly between the nodes of a table. Local frame, wo.z > 0; values
// are f cos(wi) without the colour.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/lobe.h"
#include "bsdf/matte.h"
#include "bsdf/sheen_table.h"
#include "sampling/on_axis.h"
#include "sampling/warp.h"

namespace lancer {

// The cosine lobe is stretched by 1/a and sheared by b against the direction of wo along the surface.
struct SheenFit {
  float a, b, albedo;
};
inline SheenFit sheen_fit(float cos_o, float roughness) {
  constexpr float kLast = kSheenNodes - 1;
  // Cycles keeps the roughness at 1e-3 or more.
  const float y = kLast * on_axis(roughness, 1e-3f), x = kLast * on_axis(cos_o);
  const int j = std::min(static_cast<int>(y), kSheenNodes - 2), i = std::min(static_cast<int>(x), kSheenNodes - 2);
  const float v = y - static_cast<float>(j), u = x - static_cast<float>(i);
  float fit[3];
  for (int k = 0; k < 3; ++k) {
    const auto node = [&](int row, int column) { return static_cast<float>(kSheen[j + row][i + column][k]); };
    const float low = (1.0f - u) * node(0, 0) + u * node(0, 1), high = (1.0f - u) * node(1, 0) + u * node(1, 1);
    fit[k] = 1e-5f * ((1.0f - v) * low + v * high);
  }
  return {fit[0], fit[1], fit[2]};
}

// color is black where the layer does nothing: Cycles leaves it out where a or the albedo is below 1e-5.
inline Lobe make_sheen(const glm::vec3 &weight, float roughness, float cos_o) {
  SheenFit fit = sheen_fit(cos_o, roughness);
  if (fit.a < 1e-5f || fit.albedo < 1e-5f)
    fit = {1.0f, 0.0f, 0.0f};
  Lobe lobe;
  lobe.shape = LobeShape::Sheen;
  lobe.component = Component::Diffuse;
  lobe.alpha_x = fit.a;
  lobe.alpha_y = fit.b;
  lobe.color = lobe.albedo = fit.albedo * weight;
  return lobe;
}

// wi turned about n so that wo lies over +x.
inline glm::vec3 sheen_turn(const glm::vec3 &wo, const glm::vec3 &w, float sign) {
  const float length2 = wo.x * wo.x + wo.y * wo.y;
  if (!(length2 > 0.0f))
    return w;
  const float c = wo.x / std::sqrt(length2), s = sign * wo.y / std::sqrt(length2);
  return {c * w.x + s * w.y, c * w.y - s * w.x, w.z};
}

// Value and density are the same.
inline ColorValue sheen_eval(const Lobe &lobe, const glm::vec3 &wo, const glm::vec3 &wi) {
  if (!(wi.z > 0.0f))
    return {};
  const float a = lobe.alpha_x, b = lobe.alpha_y;
  const glm::vec3 w = sheen_turn(wo, wi, 1.0f);
  const float x = a * w.x + b * w.z, y = a * w.y;
  const float ratio = a / (x * x + y * y + w.z * w.z);
  const float value = kInvPi * w.z * ratio * ratio;
  return {glm::vec3(value), value};
}

inline glm::vec3 sheen_sample(const Lobe &lobe, const glm::vec3 &wo, glm::vec2 u) {
  const glm::vec3 w = warp_cosine_hemisphere(u);
  const float a = lobe.alpha_x, b = lobe.alpha_y;
  return sheen_turn(wo, glm::normalize(glm::vec3(w.x - w.z * b, w.y, w.z * a)), -1.0f);
}

} // namespace lancer
