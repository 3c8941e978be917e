// The importance of a light or cluster at a point: the weights by which the light tree chooses. They are upper and lower bounds
// of the arriving light, as in Cycles: where only one technique can find a light, the picture depends on these densities.
// Unlike in Cycles, rounding never drops a light that contributes: its probability stays positive. F is a float, or lanes of
// floats: points that evaluate the same light.
#pragma once

#include "lights/light_bounds.h"
#include "simd/vectors.h"

namespace lancer {

// The points that choose a light: position, shading normal, and whether the surface transmits light.
template <class F> struct LightQueryLanes {
  Double3Of<F> p;
  Vector3<F> n;
  MaskOf<F> transmits;
  Vector3<F> p_float;
  F slack; // bound of the rounding error of p_float

  LANCER_LANE LightQueryLanes(const Double3Of<F> &point, const Vector3<F> &normal, MaskOf<F> through)
      : p(point), n(normal), transmits(through), p_float(narrow(point)),
        slack(F(0x1p-22f) * (abs(p_float.x) + abs(p_float.y) + abs(p_float.z))) {}
};

// Bounds of the arriving light; most > 0 wherever light may arrive.
template <class F> struct Importance { F most, least; };

// The weights ignore occluders: if a bright light is occluded, a dim one may give all the light. So each of n lights or
// clusters that may contribute gets at least kRaised / n times the largest weight. Raised weights take at most the share
// kRaised of all choices.
inline constexpr float kRaised = 0x1p-8f;

// A light as seen from the point.
template <class F> struct LightView {
  Vector3<F> to;  // unit, towards its centre
  F cos_u, sin_u; // of the half angle that it subtends
  F near2, far2;  // its squared distance, at least and at most
};

// The directions into which a light shines: ShineCone without its axis.
template <class F> struct ConeCosines {
  F cos_o, sin_o, cos_all, cos_full;

  LANCER_LANE explicit ConeCosines(const ShineCone &cone)
      : cos_o(cone.cos_o), sin_o(cone.sin_o), cos_all(cone.cos_all), cos_full(cone.cos_full) {}
  // A cone of directions around a single axis, up to this angle.
  LANCER_LANE explicit ConeCosines(float cos_e) : cos_o(1.0f), sin_o(0.0f), cos_all(cos_e), cos_full(cos_e) {}
};

// Bound of the rounding error of a cosine. A cosine above -kCosineSlack may be positive, and the weight then uses at least
// kCosineSlack.
inline constexpr float kCosineSlack = 0x1p-20f;
// Scenes and trees are about 1024 wide: no squared distance is below the rounding of a float position, and no positive
// importance is below kLeastImportance.
inline constexpr float kNearest2 = 0x1p-40f, kLeastImportance = 0x1p-60f;

template <class F> LANCER_LANE F sine_of(F cosine) { return sqrt(max(F(0.0f), (F(1.0f) - cosine) * (F(1.0f) + cosine))); }

// Returns the cosine of an angle that is reduced by another one, at most to 0; the sines are those of both angles.
template <class F> LANCER_LANE F reduced(F cosine, F sine, F cos_by, F sin_by) {
  return select(cosine >= cos_by, F(1.0f), cosine * cos_by + sine * sin_by);
}

// Returns the importance where a condition holds, 0 elsewhere.
template <class F> LANCER_LANE Importance<F> where(MaskOf<F> holds, const Importance<F> &importance) {
  const F zero(0.0f);
  return {select(holds, importance.most, zero), select(holds, importance.least, zero)};
}

// cos_theta: between the cone's axis and the direction from the light to the point.
template <class F>
LANCER_LANE Importance<F> importance(const LightQueryLanes<F> &query, const LightView<F> &view, const ConeCosines<F> &cone,
                                     F cos_theta, F energy) {
  using M = MaskOf<F>;
  const F zero(0.0f), one(1.0f), slack(kCosineSlack);
  // Cosines of the smallest and the largest angle at which light may arrive.
  const F along = dot(view.to, query.n), cos_i = select(query.transmits, abs(along), along), sin_i = sine_of(cos_i);
  const F cos_i_least = reduced(cos_i, sin_i, view.cos_u, view.sin_u);
  const F cos_i_most = max(cos_i * view.cos_u - sin_i * view.sin_u, zero);
  // Cosines of the angles at which light may leave.
  const F sin_theta = sine_of(cos_theta);
  const F inner = cos_theta * view.cos_u + sin_theta * view.sin_u, outer = cos_theta * view.cos_u - sin_theta * view.sin_u;
  const M within = (cos_theta >= view.cos_u) | (inner >= cone.cos_o);
  const F cos_out_least = select(within, one, inner * cone.cos_o + sine_of(inner) * cone.sin_o);
  const M seen = within | (inner > cone.cos_all - slack);
  const M able = seen & !(cos_i_least < -slack);
  const F near2 = max(view.near2, F(kNearest2)), far2 = max(view.far2, F(kNearest2));
  const F most = energy * max(cos_i_least, slack) * max(cos_out_least, slack) / near2;
  const M sure = (cos_theta >= zero) & (view.cos_u >= zero) & (outer >= cone.cos_full);
  const F least = abs(cos_i_most * energy * (outer * cone.cos_o - sine_of(outer) * cone.sin_o)) / far2;
  return where<F>(able, Importance<F>{max(most, F(kLeastImportance)), select(sure, least, zero)});
}

// The importance of a box of lights: the most frequent case.
template <class F>
LANCER_LANE Importance<F> cluster_importance(const LightQueryLanes<F> &query, const Vector3<F> &centre, const Vector3<F> &half,
                                             const ShineCone &cone, float energy) {
  const F zero(0.0f), one(1.0f);
  const Vector3<F> v = centre - query.p_float;
  const F d2 = dot(v, v), r2 = dot(half, half), d = sqrt(d2);
  // Skip a box that lies entirely below the surface.
  const F reach = dot(Vector3<F>(abs(query.n.x), abs(query.n.y), abs(query.n.z)), half) + query.slack;
  const MaskOf<F> able = query.transmits | (dot(query.n, v) + reach > zero), outside = d2 > r2;
  const F sin2 = select(outside, r2 / d2, zero), near2 = max(d2, F(0.25f) * r2);
  const LightView<F> view{select(d > zero, v / d, Vector3<F>(zero)), select(outside, sqrt(one - sin2), F(-1.0f)), sqrt(sin2),
                          near2, near2};
  const F cos_theta = -dot(Vector3<F>(cone.axis), view.to);
  return where<F>(able, importance(query, view, ConeCosines<F>(cone), cos_theta, F(energy)));
}
template <class F> LANCER_LANE Importance<F> importance(const LightQueryLanes<F> &query, const ClusterShape &cluster) {
  return cluster_importance(query, Vector3<F>(cluster.centre), Vector3<F>(cluster.half), cluster.cone, cluster.energy);
}

// The importance of distant lights: a disk of the sky at distance 1.
template <class F> LANCER_LANE Importance<F> importance_far(const LightQueryLanes<F> &query, const ClusterShape &cluster) {
  const F one(1.0f), cos_u = max(F(cluster.cone.cos_all), F(-1.0f));
  const LightView<F> view{-Vector3<F>(cluster.cone.axis), cos_u, sine_of(cos_u), one, one};
  return importance(query, view, ConeCosines<F>(cluster.cone), one, F(cluster.energy));
}

template <class F> LANCER_LANE Importance<F> sun_importance(const LightQueryLanes<F> &query, const TreeLight &light) {
  const F one(1.0f), cos_u(light.cos_e);
  const LightView<F> view{Vector3<F>(light.axis), cos_u, sine_of(cos_u), one, one / max(cos_u * cos_u, F(0x1p-40f))};
  return importance(query, view, ConeCosines<F>(light.cos_e), one, F(light.energy));
}

// Returns the half angle that a round light subtends, and its distances.
template <class F> LANCER_LANE LightView<F> view_round(const TreeLight &light, const Vector3<F> &to, F d) {
  const F zero(0.0f), one(1.0f), r2(light.radius * light.radius), d2 = d * d;
  if (light.kind == TreeLight::Kind::Disk) {
    const F far2 = max(d2 + r2, F(kNearest2));
    return {to, sqrt(d2 / far2), sqrt(r2 / far2), d2, far2};
  }
  // Inside the ball, light arrives from everywhere, as strong as at 0.7 of the radius.
  const MaskOf<F> outside = d2 > r2;
  const F sin2 = r2 / d2, within2 = F(0.5f) * r2;
  return {to, select(outside, sqrt(one - sin2), F(-1.0f)), select(outside, sqrt(sin2), zero), select(outside, d2, within2),
          select(outside, d2 / max(one - sin2, F(0x1p-24f)), within2)};
}

template <class F>
LANCER_LANE Importance<F> round_importance(const LightQueryLanes<F> &query, const TreeLight &light, const Vector3<F> &to, F d) {
  const F one(1.0f), energy(light.energy);
  const LightView<F> view = view_round(light, to, d);
  if (!light.spot)
    return importance(query, view, ConeCosines<F>(0.0f), one, energy);
  // The largest transmission of the spot's rim towards the angle that the light subtends.
  const F cos_theta = -dot(Vector3<F>(light.axis), to);
  const F best = reduced(cos_theta, sine_of(cos_theta), view.cos_u, view.sin_u);
  const F inside = best - F(light.cos_e) + F(kCosineSlack);
  const F t = select(inside < F(light.blend), inside / F(light.blend), one);
  const F passed = max(energy * t * t * (F(3.0f) - F(2.0f) * t), F(kLeastImportance));
  return where<F>(inside > F(0.0f), importance(query, view, ConeCosines<F>(light.cos_e), cos_theta, passed));
}

template <class F>
LANCER_LANE Importance<F> area_importance(const LightQueryLanes<F> &query, const TreeLight &light, const Vector3<F> &to, F d,
                                          const Vector3<F> &v) {
  const F zero(0.0f), one(1.0f), u_x(light.u.x), u_y(light.u.y), u_z(light.u.z), v_x(light.v.x), v_y(light.v.y), v_z(light.v.z);
  // Take the largest distance and angle over the four corners.
  F apart[4], d2[4], above[4];
  for (int corner = 0; corner < 4; ++corner) {
    const F along_u(corner & 1 ? -1.0f : 1.0f), along_v(corner & 2 ? -1.0f : 1.0f);
    const F x = v.x + along_u * u_x + along_v * v_x, y = v.y + along_u * u_y + along_v * v_y,
            z = v.z + along_u * u_z + along_v * v_z;
    d2[corner] = x * x + y * y + z * z;
    const F per_d = one / sqrt(max(d2[corner], F(kNearest2)));
    const F ax = x * per_d - to.x, ay = y * per_d - to.y, az = z * per_d - to.z;
    apart[corner] = ax * ax + ay * ay + az * az;
    above[corner] = query.n.x * x + query.n.y * y + query.n.z * z;
  }
  const auto largest = [](const F(&x)[4]) __attribute__((always_inline)) { return max(max(x[0], x[1]), max(x[2], x[3])); };
  // |a - b|^2 = 2 (1 - cos): no cancellation, however small the light.
  const F one_minus_cos = F(0.5f) * largest(apart), near2 = d * d;
  const LightView<F> view{to, one - one_minus_cos, sqrt(max(zero, one_minus_cos * (F(2.0f) - one_minus_cos))), near2,
                          max(near2, largest(d2))};
  const F facing = dot(Vector3<F>(light.axis), to), slack = F(kCosineSlack) * sqrt(view.far2);
  const MaskOf<F> able = query.transmits | ((facing < F(kCosineSlack)) & (largest(above) > -slack));
  return where<F>(able, importance(query, view, ConeCosines<F>(light.cos_e), -facing, F(light.energy)));
}

template <class F> LANCER_LANE Importance<F> importance(const LightQueryLanes<F> &query, const TreeLight &light) {
  if (light.kind == TreeLight::Kind::Sun)
    return sun_importance(query, light);
  if (light.kind == TreeLight::Kind::Sky)
    return {F(light.energy), F(0.0f)};
  if (light.kind == TreeLight::Kind::Cluster) {
    const Vector3<F> centre{F(static_cast<float>(light.centre.x)), F(static_cast<float>(light.centre.y)),
                            F(static_cast<float>(light.centre.z))};
    return cluster_importance(query, centre, Vector3<F>(light.u), light.cone, light.energy);
  }
  // Subtract in double: a lamp may be closer than float resolves.
  const Vector3<F> v = narrow(Double3Of<F>(light.centre) - query.p);
  const F d = sqrt(dot(v, v)), zero(0.0f);
  const Vector3<F> to = select(d > zero, v / d, Vector3<F>(zero));
  if (light.kind == TreeLight::Kind::Area)
    return area_importance(query, light, to, d, v);
  return round_importance(query, light, to, d);
}

} // namespace lancer
