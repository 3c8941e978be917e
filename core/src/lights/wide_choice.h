// FewLights::choose() for many lanes at once where all lights stand in one leaf, with the bits of few_lights.cpp and
// tree_light.cpp. For kernels only, like sampling/lanes.h.
#pragma once

#include "lights/tree_light.h"
#include "sampling/lane_vectors.h"

namespace lancer {
namespace {

struct WideQuery {
  D3 p;
  V3 n;
  M transmits;
};
struct WideImportance {
  F most, least;
};
struct WideView {
  V3 to;
  F cos_u, sin_u, near2, far2;
};
struct WideCone {
  F cos_o, sin_o, cos_all, cos_full;
};

LANCER_LANE F wide_sine(F cosine) { return sqrt(max(F(0.0f), (F(1.0f) - cosine) * (F(1.0f) + cosine))); }

LANCER_LANE WideImportance wide_importance(const WideQuery &query, const WideView &view, const WideCone &cone, F cos_theta,
                                           F energy) {
  const F zero(0.0f), one(1.0f);
  const F along = dot(view.to, query.n), cos_i = select(query.transmits, abs(along), along), sin_i = wide_sine(cos_i);
  const F cos_i_least = select(cos_i >= view.cos_u, one, cos_i * view.cos_u + sin_i * view.sin_u);
  const F cos_i_most = max(cos_i * view.cos_u - sin_i * view.sin_u, zero);
  const F sin_theta = wide_sine(cos_theta);
  const F inner = cos_theta * view.cos_u + sin_theta * view.sin_u, outer = cos_theta * view.cos_u - sin_theta * view.sin_u;
  const M within = (cos_theta >= view.cos_u) | (inner >= cone.cos_o);
  const F cos_out_least = select(within, one, inner * cone.cos_o + wide_sine(inner) * cone.sin_o);
  const M seen = within | (inner > cone.cos_all - F(kCosineSlack));
  const M able = seen & !(cos_i_least < F(-kCosineSlack));
  const F near2 = max(view.near2, F(kNearest2)), far2 = max(view.far2, F(kNearest2));
  const F most = energy * max(cos_i_least, F(kCosineSlack)) * max(cos_out_least, F(kCosineSlack)) / near2;
  const M sure = (cos_theta >= zero) & (view.cos_u >= zero) & (outer >= cone.cos_full);
  const F least = abs(cos_i_most * energy * (outer * cone.cos_o - wide_sine(outer) * cone.sin_o)) / far2;
  return {select(able, max(most, F(kLeastImportance)), zero), select(able & sure, least, zero)};
}

LANCER_LANE WideImportance round_importance(const WideQuery &query, const TreeLight &light, const V3 &to, F d) {
  const F zero(0.0f), one(1.0f), r2(light.radius * light.radius), d2 = d * d;
  WideView view;
  view.to = to;
  view.near2 = d2;
  if (light.kind == TreeLight::Kind::Disk) {
    view.far2 = max(d2 + r2, F(kNearest2));
    view.sin_u = sqrt(r2 / view.far2);
    view.cos_u = sqrt(d2 / view.far2);
  } else {
    const M outside = d2 > r2;
    const F sin2 = r2 / d2;
    view.sin_u = select(outside, sqrt(sin2), zero);
    view.cos_u = select(outside, sqrt(one - sin2), F(-1.0f));
    view.far2 = select(outside, d2 / max(one - sin2, F(0x1p-24f)), F(0.5f) * r2);
    view.near2 = select(outside, d2, F(0.5f) * r2);
  }
  WideCone cone{one, zero, zero, zero};
  if (!light.spot)
    return wide_importance(query, view, cone, one, F(light.energy));
  cone.cos_all = cone.cos_full = F(light.cos_e);
  const V3 axis{F(light.axis.x), F(light.axis.y), F(light.axis.z)};
  const F cos_theta = -dot(axis, to);
  const F best = select(cos_theta >= view.cos_u, one, cos_theta * view.cos_u + wide_sine(cos_theta) * view.sin_u);
  const F inside = best - F(light.cos_e) + F(kCosineSlack);
  const F t = select(inside < F(light.blend), inside / F(light.blend), one);
  const F energy = max(F(light.energy) * t * t * (F(3.0f) - F(2.0f) * t), F(kLeastImportance));
  const WideImportance all = wide_importance(query, view, cone, cos_theta, energy);
  const M lit = inside > zero;
  return {select(lit, all.most, zero), select(lit, all.least, zero)};
}

LANCER_LANE WideImportance area_importance(const WideQuery &query, const TreeLight &light, const V3 &to, F d, const V3 &v) {
  const F zero(0.0f), one(1.0f);
  // Look at the four corners.
  F apart[4], d2[4], above[4];
  for (int corner = 0; corner < 4; ++corner) {
    const F along_u(corner & 1 ? -1.0f : 1.0f), along_v(corner & 2 ? -1.0f : 1.0f);
    const F x = v.x + along_u * F(light.u.x) + along_v * F(light.v.x),
            y = v.y + along_u * F(light.u.y) + along_v * F(light.v.y),
            z = v.z + along_u * F(light.u.z) + along_v * F(light.v.z);
    d2[corner] = x * x + y * y + z * z;
    const F per_d = one / sqrt(max(d2[corner], F(kNearest2)));
    const F ax = x * per_d - to.x, ay = y * per_d - to.y, az = z * per_d - to.z;
    apart[corner] = ax * ax + ay * ay + az * az;
    above[corner] = query.n.x * x + query.n.y * y + query.n.z * z;
  }
  const auto largest = [](const F(&x)[4]) __attribute__((always_inline)) { return max(max(x[0], x[1]), max(x[2], x[3])); };
  const F one_minus_cos = F(0.5f) * largest(apart);
  WideView view;
  view.to = to;
  view.near2 = d * d;
  view.far2 = max(view.near2, largest(d2));
  view.cos_u = one - one_minus_cos;
  view.sin_u = sqrt(max(zero, one_minus_cos * (F(2.0f) - one_minus_cos)));
  const V3 axis{F(light.axis.x), F(light.axis.y), F(light.axis.z)};
  const F facing = dot(axis, to), slack = F(kCosineSlack) * sqrt(view.far2);
  const M able = query.transmits | ((facing < F(kCosineSlack)) & (largest(above) > -slack));
  const WideCone cone{one, zero, F(light.cos_e), F(light.cos_e)};
  const WideImportance all = wide_importance(query, view, cone, -facing, F(light.energy));
  return {select(able, all.most, zero), select(able, all.least, zero)};
}

// Of lights with a place that are no clusters.
LANCER_LANE WideImportance lamp_importance(const WideQuery &query, const TreeLight &light) {
  const V3 v = narrow(D3{D(light.centre.x) - query.p.x, D(light.centre.y) - query.p.y, D(light.centre.z) - query.p.z});
  const F d = sqrt(dot(v, v)), zero(0.0f);
  const V3 to = select(d > zero, v / d, V3{zero, zero, zero});
  if (light.kind == TreeLight::Kind::Area)
    return area_importance(query, light, to, d, v);
  return round_importance(query, light, to, d);
}

constexpr uint32_t kWideLeafLights = 8;

struct WideChoice {
  U number;
  D probability;
};

// choose_of_leaf().
LANCER_LANE WideChoice choose_lamp(const WideQuery &query, const TreeLight *lights, uint32_t count, D u) {
  WideChoice choice{U(lights[0].number), D(1.0)};
  if (count == 1)
    return choice;
  const D zero(0.0), half(0.5);
  WideImportance parts[kWideLeafLights];
  D most = zero, least = zero, able = zero;
  for (uint32_t i = 0; i < count; ++i) {
    parts[i] = lamp_importance(query, lights[i]);
    most = most + widen(parts[i].most);
    least = least + widen(parts[i].least);
    able = select(parts[i].most > F(0.0f), able + D(1.0), able);
  }
  choice.probability = zero;
  M open = mask_of((1u << kLanes) - 1u);
  for (uint32_t i = 0; i < count; ++i) {
    const D lower = select(least > zero, widen(parts[i].least) / least, D(1.0) / able);
    const D share = select(parts[i].most > F(0.0f), half * (widen(parts[i].most) / most + lower), zero);
    const M there = open & (share > zero);
    choice.number = select(there, U(lights[i].number), choice.number);
    choice.probability = select(there, share, choice.probability);
    open = open & !(there & (u < share));
    u = select(there, u - share, u);
  }
  return choice;
}

} // namespace
} // namespace lancer
