// Cloth by multiple scattering in a layer of microfibres (Zeltner, Burley, Chiang 2022): a linearly transformed cosine whose
// two coefficients and albedo depend on wo and the roughness, interpolated linearly in a table. Local frame, wo.z > 0; values
// are f cos(wi) without the colour.
#pragma once

#include "bsdf/albedo_tables.h"
#include "bsdf/lobe.h"
#include "bsdf/sheen_table.h"
#include "sampling/warp.h"

namespace lancer {

// The cosine lobe is stretched by 1/a and sheared by b against the tangential direction of wo.
template <class F> struct SheenFit { F a, b, albedo; };
template <class F> LANCER_LANE SheenFit<F> sheen_fit(F cos_o, F roughness) {
  constexpr float kLast = kSheenNodes - 1;
  // Cycles clamps the roughness to at least 1e-3.
  const F y = kLast * on_axis(roughness, 1e-3f), x = kLast * on_axis(cos_o);
  const F row = min(to_float(truncate(y)), F(kSheenNodes - 2)), column = min(to_float(truncate(x)), F(kSheenNodes - 2));
  const F v = y - row, u = x - column;
  const auto first = truncate((row * float(kSheenNodes) + column) * 3.0f);
  const uint32_t *table = reinterpret_cast<const uint32_t *>(&kSheen[0][0][0]);
  F fit[3];
  for (uint32_t k = 0; k < 3; ++k) {
    const auto node = [&](uint32_t down, uint32_t right) __attribute__((always_inline)) {
      return to_float(gather(table + (down * kSheenNodes + right) * 3 + k, first));
    };
    const F low = (1.0f - u) * node(0, 0) + u * node(0, 1), high = (1.0f - u) * node(1, 0) + u * node(1, 1);
    fit[k] = 1e-5f * ((1.0f - v) * low + v * high);
  }
  return {fit[0], fit[1], fit[2]};
}

// color is black if the layer has no effect: Cycles drops the layer if a or the albedo is below 1e-5.
template <class F> LANCER_LANE Lobe<F> make_sheen(const Vec3<F> &weight, F roughness, F cos_o) {
  SheenFit<F> fit = sheen_fit(cos_o, roughness);
  const auto nothing = (fit.a < 1e-5f) | (fit.albedo < 1e-5f);
  Lobe<F> lobe;
  lobe.shape = LobeShape::Sheen;
  lobe.component = Component::Diffuse;
  lobe.alpha_x = select(nothing, F(1.0f), fit.a);
  lobe.alpha_y = select(nothing, F(0.0f), fit.b);
  lobe.color = lobe.albedo = select(nothing, F(0.0f), fit.albedo) * weight;
  return lobe;
}

// Rotates w about n so that wo is above +x.
template <class V> LANCER_LANE V sheen_turn(const V &wo, const V &w, float sign) {
  using F = NumberOf<V>;
  const F length2 = wo.x * wo.x + wo.y * wo.y;
  const F c = wo.x / sqrt(length2), s = sign * wo.y / sqrt(length2);
  return select(length2 > 0.0f, V(c * w.x + s * w.y, c * w.y - s * w.x, w.z), w);
}

// Value and density are equal.
template <class F> LANCER_LANE ColorValue<F> sheen_eval(const Lobe<F> &lobe, const Vec3<F> &wo, const Vec3<F> &wi) {
  const F a = lobe.alpha_x, b = lobe.alpha_y;
  const Vec3<F> w = sheen_turn(wo, wi, 1.0f);
  const F x = a * w.x + b * w.z, y = a * w.y;
  const F ratio = a / (x * x + y * y + w.z * w.z);
  const F value = kInvPi * w.z * ratio * ratio;
  return where<F>(wi.z > 0.0f, {Vec3<F>(value), value});
}

template <class F> LANCER_LANE Vec3<F> sheen_sample(const Lobe<F> &lobe, const Vec3<F> &wo, F u, F v) {
  const Vec3<F> w = warp_cosine_hemisphere(u, v);
  const F a = lobe.alpha_x, b = lobe.alpha_y;
  return sheen_turn(wo, normalize(Vec3<F>(w.x - w.z * b, w.y, w.z * a)), -1.0f);
}

} // namespace lancer
