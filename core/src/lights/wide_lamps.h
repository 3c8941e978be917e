// Samples of lights as described for many lanes at once, with the bits of area_light.h, point_light.h and sun_light.h. For
// kernels only, like simd/lanes.h.
#pragma once

#include "lights/area_end.h"
#include "lights/wide_lamp.h"
#include "simd/kernel_lanes.h"

#include <numbers>

namespace lancer {
namespace {

#define LANCER_LAMP(name)                                                                                                      \
  lamp_number(                                                                                                                 \
      lamps, [](const WideLamp &lamp) __attribute__((always_inline)) { return lamp.name; })
#define LANCER_LAMP3(name)                                                                                                     \
  D3 { LANCER_LAMP(name[0]), LANCER_LAMP(name[1]), LANCER_LAMP(name[2]) }
template <class Get> LANCER_LANE D lamp_number(const WideLamp *const *lamps, Get get) {
  alignas(64) double values[kLanes];
  for (int i = 0; i < kLanes; ++i)
    values[i] = get(*lamps[i]);
  return load(values);
}

struct WideLight {
  D3 target, wi;
  V3 radiance;
  D pdf;
  M delta;
};

// sample_area().
LANCER_LANE void sample_area(const WideLamp *const *lamps, const D3 &p, F u, F v, F disk_x, F disk_y, M which, M ellipse,
                             WideLight &light) {
  const D3 position = LANCER_LAMP3(position), x = LANCER_LAMP3(x), y = LANCER_LAMP3(y), z = LANCER_LAMP3(z);
  const D half_x = LANCER_LAMP(half_x), half_y = LANCER_LAMP(half_y), whole = LANCER_LAMP(area);
  const D scale = LANCER_LAMP(spread_scale), tangent_limit = LANCER_LAMP(tan_half_spread);
  const D one(1.0), zero(0.0);
  // The part of it whose spread reaches p.
  D low_x(-1.0), low_y(-1.0), high_x(1.0), high_y(1.0), area = whole;
  M round = ellipse;
  const M narrowed = which & (scale != zero);
  if (any(narrowed)) {
    const D3 to = p - position;
    const D radius = -dot(to, z) * tangent_limit;
    const D foot_x = dot(to, x) / half_x, foot_y = dot(to, y) / half_y;
    const D lx = max(foot_x - radius / half_x, D(-1.0)), ly = max(foot_y - radius / half_y, D(-1.0));
    const D hx = min(foot_x + radius / half_x, one), hy = min(foot_y + radius / half_y, one);
    const D part = max(hx - lx, zero) * max(hy - ly, zero) * half_x * half_y;
    const M smaller = narrowed & (part < whole);
    low_x = select(smaller, lx, low_x);
    low_y = select(smaller, ly, low_y);
    high_x = select(smaller, hx, high_x);
    high_y = select(smaller, hy, high_y);
    area = select(smaller, part, area);
    round = round & !smaller;
  }
  // A point of it, and the direction there.
  const D du = widen(u), dv = widen(v);
  const D across = select(round, widen(disk_x), low_x * (one - du) + high_x * du);
  const D along = select(round, widen(disk_y), low_y * (one - dv) + high_y * dv);
  const D3 to_light = position + across * half_x * x + along * half_y * y - p;
  const D distance = sqrt(dot(to_light, to_light));
  const D3 wi = to_light / distance;
  const D cosine = dot(wi, z);
  const M outside = ellipse & !round & !(across * across + along * along <= one);
  const M valid = which & (area > zero) & (distance > zero) & (cosine > zero) & !outside;
  const D3 target = p + area_end(distance, cosine, LANCER_LAMP(apart)) * wi;
  const D pdf = distance * distance / (cosine * area);
  const D3 emission = LANCER_LAMP3(emission);
  V3 radiance = narrow(emission);
  if (any(narrowed)) {
    const D tangent = sqrt(max(zero, (one - cosine) * (one + cosine))) / cosine;
    radiance = select(narrowed, narrow(emission * (max(tangent_limit - tangent, zero) * scale)), radiance);
  }
  light.target = select(which, target, light.target);
  light.wi = select(which, wi, light.wi);
  light.radiance = select(which, radiance, light.radiance);
  light.pdf = select(valid, pdf, light.pdf);
}

// spot_attenuation().
LANCER_LANE D spot_attenuation(const WideLamp *const *lamps, const D3 &wi, M spot) {
  const D one(1.0), zero(0.0);
  if (!any(spot))
    return one;
  const D3 z = LANCER_LAMP3(z);
  const D stretch_x = LANCER_LAMP(stretch_x), stretch_y = LANCER_LAMP(stretch_y);
  D cosine = dot(wi, z);
  const M stretched = (stretch_x != one) | (stretch_y != one);
  if (any(stretched & spot)) {
    const D x = dot(wi, LANCER_LAMP3(x)) / stretch_x, y = dot(wi, LANCER_LAMP3(y)) / stretch_y;
    cosine = select(stretched, cosine / sqrt(x * x + y * y + cosine * cosine), cosine);
  }
  const D inside = cosine - LANCER_LAMP(cos_half_angle), blend = LANCER_LAMP(blend_width);
  const D by_cosine = LANCER_LAMP(spot_cosine);
  const D tilted = select(by_cosine != zero, max(cosine, zero), one);
  const D t = inside / blend;
  const D value = select(inside >= blend, tilted, tilted * t * t * (D(3.0) - D(2.0) * t));
  return select(spot, select(inside > zero, value, zero), one);
}

// Any two unit vectors across unit n.
LANCER_LANE void complete_frame(const D3 &n, D3 &s, D3 &t) {
  const D one(1.0);
  const D side = sign(n.z);
  const D a = D(-1.0) / (side + n.z), b = n.x * n.y * a;
  s = {one + side * n.x * n.x * a, side * b, -side * n.x};
  t = {b, side + n.y * n.y * a, -n.y};
}

LANCER_LANE D3 unit_of(const D3 &v) { return v * (D(1.0) / sqrt(dot(v, v))); }
LANCER_LANE D3 cone_direction(const D3 &axis, const D3 &s, const D3 &t, D cone, F disk_x, F disk_y) {
  const D one(1.0), dx = widen(disk_x), dy = widen(disk_y);
  const D r2 = min(one, dx * dx + dy * dy), x = r2 * cone, spread = sqrt(cone * (D(2.0) - x));
  return unit_of((one - x) * axis + dx * spread * s + dy * spread * t);
}

// sample_point(): true points, disks that face p, and balls seen from outside; inside: lanes within their ball.
LANCER_LANE void sample_round(const WideLamp *const *lamps, const D3 &p, F disk_x, F disk_y, M which, M soft, M spot,
                              WideLight &light, M &inside) {
  const D one(1.0), zero(0.0), radius = LANCER_LAMP(radius);
  const D3 position = LANCER_LAMP3(position), emission = LANCER_LAMP3(emission);
  const D3 to_light = position - p;
  const D distance = sqrt(dot(to_light, to_light));
  const D3 axis = to_light / distance;
  const M point = which & (radius <= distance * D(0x1p-24)), disk = which & soft & !point, ball = which & !soft & !point;
  inside = ball & !(distance > radius);
  D3 target = position, wi = axis;
  D pdf = one;
  D3 s, t;
  complete_frame(axis, s, t);
  if (any(disk)) {
    const D x = widen(disk_x) * radius, y = widen(disk_y) * radius;
    const D3 at = position + x * s + y * t;
    const D3 v = at - p;
    const D far = sqrt(dot(v, v));
    const D3 w = v / far;
    const D cosine = dot(w, axis);
    target = select(disk, at, target);
    wi = select(disk, w, wi);
    pdf = select(disk, far * far / (cosine * D(std::numbers::pi) * radius * radius), pdf);
  }
  if (any(ball)) {
    const D ratio = radius / distance, sin2 = ratio * ratio;
    const D cos2 = (distance - radius) * (distance + radius) / (distance * distance);
    const D cone = sin2 / (one + sqrt(max(zero, cos2)));
    const D3 w = cone_direction(axis, s, t, cone, disk_x, disk_y);
    const D along = dot(to_light, w);
    const D3 closest = along * w - to_light;
    const D miss = sqrt(dot(closest, closest));
    const D half = sqrt(max(zero, (radius - miss) * (radius + miss)));
    const D reach = max(along - half, D(0.5) * along);
    target = select(ball, p + reach * w, target);
    wi = select(ball, w, wi);
    pdf = select(ball, one / (D(2.0 * std::numbers::pi) * cone), pdf);
  }
  const D attenuation = spot_attenuation(lamps, wi, spot & which);
  const D scale = select(point, attenuation / (distance * distance), attenuation / (D(std::numbers::pi) * radius * radius));
  light.target = select(which, target, light.target);
  light.wi = select(which, wi, light.wi);
  light.radiance = select(which, narrow(emission * scale), light.radiance);
  light.pdf = select(which & (distance > zero), pdf, light.pdf);
  light.delta = light.delta | point;
}

// sample_sun(): single directions, even disks and flat ones.
LANCER_LANE void sample_sun(const WideLamp *const *lamps, F disk_x, F disk_y, M which, WideLight &light) {
  const D one(1.0), zero(0.0), pi(std::numbers::pi);
  const D size = LANCER_LAMP(one_minus_cos_sun), radius = LANCER_LAMP(flat_radius);
  const D3 x = LANCER_LAMP3(x), y = LANCER_LAMP3(y), z = LANCER_LAMP3(z), emission = LANCER_LAMP3(emission);
  const M single = which & (size == zero), flat = which & !single & (radius != zero), even = which & !single & !flat;
  D3 wi = z;
  V3 radiance = narrow(emission);
  D pdf = one;
  // sun_disk()
  if (any(even)) {
    wi = select(even, cone_direction(z, x, y, size, disk_x, disk_y), wi);
    radiance = select(even, narrow(emission / (pi * (size * (D(2.0) - size)))), radiance);
    pdf = select(even, one / (D(2.0 * std::numbers::pi) * size), pdf);
  }
  if (any(flat)) {
    const D3 w = unit_of(z + radius * widen(disk_x) * x + radius * widen(disk_y) * y);
    const D cosine = dot(w, z), r2 = radius * radius, density = one / (pi * r2 * cosine * cosine * cosine);
    wi = select(flat, w, wi);
    radiance = select(flat, narrow(emission * (D(0.5) * (sqrt(one + r2) + one) * density)), radiance);
    pdf = select(flat, density, pdf);
  }
  light.wi = select(which, wi, light.wi);
  light.radiance = select(which, radiance, light.radiance);
  light.pdf = select(which, pdf, light.pdf);
  light.delta = light.delta | single;
}

#undef LANCER_LAMP
#undef LANCER_LAMP3

} // namespace
} // namespace lancer
