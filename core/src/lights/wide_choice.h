// FewLights::choose() for many lanes at once, with the bits of few_lights.cpp and tree_light.cpp. For kernels only, like
// simd/lanes.h.
#pragma once

#include "lights/few_lights.h"
#include "lights/wide_sine.h"
#include "simd/kernel_lanes.h"

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

LANCER_LANE WideImportance wide_importance(const WideQuery &query, const WideView &view, const WideCone &cone, F cos_theta,
                                           F energy) {
  const F zero(0.0f), one(1.0f);
  const F along = dot(view.to, query.n), cos_i = select(query.transmits, abs(along), along), sin_i = sine_of(cos_i);
  const F cos_i_least = select(cos_i >= view.cos_u, one, cos_i * view.cos_u + sin_i * view.sin_u);
  const F cos_i_most = max(cos_i * view.cos_u - sin_i * view.sin_u, zero);
  const F sin_theta = sine_of(cos_theta);
  const F inner = cos_theta * view.cos_u + sin_theta * view.sin_u, outer = cos_theta * view.cos_u - sin_theta * view.sin_u;
  const M within = (cos_theta >= view.cos_u) | (inner >= cone.cos_o);
  const F cos_out_least = select(within, one, inner * cone.cos_o + sine_of(inner) * cone.sin_o);
  const M seen = within | (inner > cone.cos_all - F(kCosineSlack));
  const M able = seen & !(cos_i_least < F(-kCosineSlack));
  const F near2 = max(view.near2, F(kNearest2)), far2 = max(view.far2, F(kNearest2));
  const F most = energy * max(cos_i_least, F(kCosineSlack)) * max(cos_out_least, F(kCosineSlack)) / near2;
  const M sure = (cos_theta >= zero) & (view.cos_u >= zero) & (outer >= cone.cos_full);
  const F least = abs(cos_i_most * energy * (outer * cone.cos_o - sine_of(outer) * cone.sin_o)) / far2;
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
  const F best = select(cos_theta >= view.cos_u, one, cos_theta * view.cos_u + sine_of(cos_theta) * view.sin_u);
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

LANCER_LANE V3 splat3(const glm::vec3 &v) { return {F(v.x), F(v.y), F(v.z)}; }
LANCER_LANE WideCone splat_cone(const ShineCone &cone) {
  return {F(cone.cos_o), F(cone.sin_o), F(cone.cos_all), F(cone.cos_full)};
}

// Of a box of lights.
LANCER_LANE WideImportance cluster_importance(const WideQuery &query, const V3 &centre, const V3 &half, const ShineCone &cone,
                                              float energy) {
  const F zero(0.0f), one(1.0f);
  const V3 p = narrow(query.p);
  const F slack = F(0x1p-22f) * (abs(p.x) + abs(p.y) + abs(p.z));
  const V3 v = centre - p;
  const F d2 = dot(v, v), r2 = dot(half, half), d = sqrt(d2);
  const F reach = dot(V3{abs(query.n.x), abs(query.n.y), abs(query.n.z)}, half) + slack;
  const M able = query.transmits | (dot(query.n, v) + reach > zero);
  const M outside = d2 > r2;
  const F sin2 = select(outside, r2 / d2, zero);
  WideView view;
  view.to = select(d > zero, v / d, V3{zero, zero, zero});
  view.sin_u = sqrt(sin2);
  view.cos_u = select(outside, sqrt(one - sin2), F(-1.0f));
  view.near2 = view.far2 = max(d2, F(0.25f) * r2);
  const WideImportance all = wide_importance(query, view, splat_cone(cone), -dot(splat3(cone.axis), view.to), F(energy));
  return {select(able, all.most, zero), select(able, all.least, zero)};
}

// Of distant ones: a disk of the sky at distance 1.
LANCER_LANE WideImportance far_importance(const WideQuery &query, const ClusterShape &cluster) {
  WideView view;
  view.to = -splat3(cluster.cone.axis);
  view.cos_u = max(F(cluster.cone.cos_all), F(-1.0f));
  view.sin_u = sine_of(view.cos_u);
  view.near2 = view.far2 = F(1.0f);
  return wide_importance(query, view, splat_cone(cluster.cone), F(1.0f), F(cluster.energy));
}

LANCER_LANE WideImportance light_importance(const WideQuery &query, const TreeLight &light) {
  if (light.kind == TreeLight::Kind::Sun) {
    WideView view;
    view.to = splat3(light.axis);
    view.cos_u = F(light.cos_e);
    view.sin_u = sine_of(view.cos_u);
    view.near2 = F(1.0f);
    view.far2 = F(1.0f) / max(view.cos_u * view.cos_u, F(0x1p-40f));
    const WideCone cone{F(1.0f), F(0.0f), F(light.cos_e), F(light.cos_e)};
    return wide_importance(query, view, cone, F(1.0f), F(light.energy));
  }
  if (light.kind == TreeLight::Kind::Sky)
    return {F(light.energy), F(0.0f)};
  if (light.kind == TreeLight::Kind::Cluster) {
    const V3 centre{F(static_cast<float>(light.centre.x)), F(static_cast<float>(light.centre.y)),
                    F(static_cast<float>(light.centre.z))};
    return cluster_importance(query, centre, splat3(light.u), light.cone, light.energy);
  }
  const V3 v = narrow(D3{D(light.centre.x) - query.p.x, D(light.centre.y) - query.p.y, D(light.centre.z) - query.p.z});
  const F d = sqrt(dot(v, v)), zero(0.0f);
  const V3 to = select(d > zero, v / d, V3{zero, zero, zero});
  if (light.kind == TreeLight::Kind::Area)
    return area_importance(query, light, to, d, v);
  return round_importance(query, light, to, d);
}

struct WideTree {
  const LightNode *nodes;
  const TreeLight *lights;
  uint32_t root;
};

struct WideChoice {
  U number;
  D probability, u; // as LightChoice
};

LANCER_LANE WideImportance weigh(const WideQuery &query, const WideTree &tree, uint32_t number) {
  const LightNode &node = tree.nodes[number];
  if (node.count == 1)
    return light_importance(query, tree.lights[node.first]);
  return node.distant ? far_importance(query, node.shape)
                      : cluster_importance(query, splat3(node.shape.centre), splat3(node.shape.half), node.shape.cone,
                                           node.shape.energy);
}

LANCER_LANE void raise(WideImportance *parts, uint32_t count) {
  const F zero(0.0f);
  F strongest = zero;
  for (uint32_t i = 0; i < count; ++i)
    strongest = max(strongest, parts[i].most);
  const F least = F(kRaised / static_cast<float>(count)) * strongest;
  for (uint32_t i = 0; i < count; ++i)
    parts[i].most = select(parts[i].most > zero, max(parts[i].most, least), zero);
}

// Shares of the sum of upper and of lower bounds, averaged.
struct WideSums {
  D most = D(0.0), least = D(0.0), able = D(0.0);

  LANCER_LANE WideSums(const WideImportance *parts, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) {
      most = most + widen(parts[i].most);
      least = least + widen(parts[i].least);
      able = select(parts[i].most > F(0.0f), able + D(1.0), able);
    }
  }
  LANCER_LANE D share(const WideImportance &part) const {
    const D lower = select(least > D(0.0), widen(part.least) / least, D(1.0) / able);
    return select(part.most > F(0.0f), D(0.5) * (widen(part.most) / most + lower), D(0.0));
  }
};

// choose_of_leaf(), of the lanes that have come to it.
LANCER_LANE void choose_of_leaf(const WideQuery &query, const WideTree &tree, const LightNode &node, M here,
                                WideChoice &choice) {
  const D zero(0.0);
  if (node.count == 1) {
    choice.number = select(here, U(tree.lights[node.first].number), choice.number);
    return;
  }
  WideImportance parts[kLeafLights];
  for (uint32_t i = 0; i < node.count; ++i)
    parts[i] = light_importance(query, tree.lights[node.first + i]);
  raise(parts, node.count);
  const WideSums sums(parts, node.count);
  D probability = zero, rest = choice.u;
  D left = choice.u;
  M open = here;
  for (uint32_t i = 0; i < node.count; ++i) {
    const D share = sums.share(parts[i]);
    const M there = open & (share > zero);
    choice.number = select(there, U(tree.lights[node.first + i].number), choice.number);
    probability = select(there, share, probability);
    rest = select(there, min(left / share, D(kBelowOne)), rest);
    const M last = there & (left < share);
    left = select(there & !last, left - share, left);
    open = open & !last;
  }
  choice.probability = select(here, probability * choice.probability, choice.probability);
  choice.u = select(here, rest, choice.u);
}

LANCER_LANE WideChoice choose_light(const WideQuery &query, const WideTree &tree, D u) {
  struct Waiting {
    uint32_t number;
    M lanes;
  };
  constexpr uint32_t kPairs = 0xffffffffu;
  WideChoice choice{U(0u), D(1.0), u};
  const D zero(0.0);
  // Each node at most once, with the lanes that go there.
  Waiting waiting[64];
  uint32_t size = 0;
  waiting[size++] = {tree.root, mask_of((1u << kLanes) - 1u)};
  while (size > 0) {
    const Waiting at = waiting[--size];
    if (at.number != kPairs && tree.nodes[at.number].count > 0) {
      choose_of_leaf(query, tree, tree.nodes[at.number], at.lanes, choice);
      continue;
    }
    const uint32_t pair = at.number == kPairs ? 0 : tree.nodes[at.number].first;
    WideImportance parts[2] = {weigh(query, tree, pair), weigh(query, tree, pair + 1)};
    raise(parts, 2);
    D x, y;
    if (pair != 0 && (tree.nodes[pair].count != 1 || tree.nodes[pair + 1].count != 1)) {
      // Between clusters the upper bounds decide.
      const D a = widen(parts[0].most), b = widen(parts[1].most), sum = a + b;
      x = select(sum > zero, a / sum, zero);
      y = select(sum > zero, b / sum, zero);
    } else {
      const WideSums sums(parts, 2);
      x = sums.share(parts[0]);
      y = sums.share(parts[1]);
    }
    const M right = (y > zero) & !(choice.u < x), none = !((x > zero) | right);
    const D share = select(right, y, x);
    const D rest = min(select(right, choice.u - x, choice.u) / share, D(kBelowOne));
    choice.u = select(at.lanes & !none, rest, choice.u);
    choice.probability = select(at.lanes, select(none, zero, choice.probability * share), choice.probability);
    const M lanes = at.lanes & !none;
    if (any(lanes & right))
      waiting[size++] = {pair + 1, lanes & right};
    if (any(lanes & !right))
      waiting[size++] = {pair, lanes & !right};
  }
  return choice;
}

} // namespace
} // namespace lancer
