// Mappings from vectors to images: flat, box, sphere and tube projection, tiles, and environment maps. Internal linkage, as in
// lanes.h.
#pragma once

#include "nodes/cell_hash.h"
#include "nodes/changes.h"
#include "nodes/look_up.h"
#include "nodes/vector_nodes.h"

namespace lancer {
namespace {

constexpr uint32_t kTileOfEachSide = 512; // flag of a box

// A place in an image, and the squares of its coordinates' changes over a pixel.
template <class F> struct Place { F u, v, u2 = F(0.0f), v2 = F(0.0f); };
template <class F> LANCER_LANE Place<F> select(const MaskOf<F> &m, const Place<F> &a, const Place<F> &b) {
  return {select(m, a.u, b.u), select(m, a.v, b.v), select(m, a.u2, b.u2), select(m, a.v2, b.v2)};
}
template <class F> LANCER_LANE Place<F> squared(const Place<Dual<F>> &place) {
  const auto square = [](const Dual<F> &x) { return x.dx * x.dx + x.dy * x.dy; };
  return {place.u.of, place.v.of, square(place.u), square(place.v)};
}

// Replaces a missing image.
template <class F> LANCER_LANE Value<F> missing() { return solid(Vector3<F>(F(1.0f), F(0.0f), F(1.0f))); }

template <class F> LANCER_LANE const ImageView &picture(const Inputs<F> &in, uint32_t number) {
  return in.images[in.node.image + number];
}

// Returns a number in [0, 1) that differs from hit to hit, and from node to node.
template <class F> F number_of_hit(const Site<F> &site, const Node &node) {
  using U = WordOf<F>;
  const auto word = [](const DoubleOf<F> &x) {
    const F high = narrow(x), low = narrow(x - widen(high));
    return as_word(high) ^ rotated(as_word(low), 16);
  };
  return unit_of<F>(cell_hash({word(site.p.x), word(site.p.y), word(site.p.z), U(uint32_t(node.inputs[0].node))}));
}

template <class F> Value<F> look_up(const Inputs<F> &in, const Site<F> &site, const ImageView &image, const Place<F> &place) {
  Texel<F> found;
  if (image.levels == 1) {
    found = look_up(image_level(image, in.node.flags), place.u, place.v);
  } else {
    const F width(static_cast<float>(image.width)), height(static_cast<float>(image.height));
    const F number = number_of_hit(site, in.node), across2 = place.u2 * (width * width), up2 = place.v2 * (height * height);
    found = look_up_level(image, in.node.flags, place.u, place.v,
                          level_of(image, across2, up2, site.displaces ? nullptr : &number));
  }
  return {found.color, found.alpha};
}

// Looks up each lane in its own image, given by the number among the node's images. A number outside the node's images gives
// missing().
template <class F>
Value<F> look_up_each(const Inputs<F> &in, const Site<F> &site, const WordOf<F> &number, const Place<F> &place) {
  Value<F> r = missing<F>();
  for (uint32_t i = 0; i < in.node.image_count; ++i) {
    const auto here = equal(number, WordOf<F>(i));
    if (any(here))
      r = select(here, look_up(in, site, picture(in, i), place), r);
  }
  return r;
}

// Looks up the tile that contains the place. Truncates, as Blender does: slightly below 0 is still the first tile.
template <class F> Value<F> look_up_tile(const Inputs<F> &in, const Site<F> &site, const Place<F> &place) {
  using U = WordOf<F>;
  const F zero(0.0f), far(1e6f);
  const auto near = (abs(place.u) < far) & (abs(place.v) < far);
  const U across = truncate(select(near, place.u, zero)), up = truncate(select(near, place.v, zero));
  const F column = to_float(across), row = to_float(up);
  const auto known = near & (column >= zero) & (column <= F(9.0f)) & (row >= zero);
  const U tile = U(1001u) + across + U(10u) * up;
  const U number = by_lane<U>([&](int i) {
    uint32_t k = 0;
    while (k < in.node.image_count && picture(in, k).tile != lane(tile, i))
      ++k;
    return k;
  });
  return look_up_each(in, site, select(known, number, U(in.node.image_count)),
                      {place.u - column, place.v - row, place.u2, place.v2});
}

// Returns longitude and latitude of a point in the box -1 ... 1.
template <class F> Place<F> on_sphere(const Vector3<F> &p) {
  constexpr float pi = 3.14159265358979323846f;
  const F zero(0.0f), half(0.5f), radius = hypot(p.x, p.y);
  const F u = select(radius > zero, half - atan2(p.x, p.y) / F(2.0f * pi), zero);
  return select(black(p), Place<F>{zero, zero}, Place<F>{u, half + atan2(p.z, radius) / F(pi)});
}

template <class F> Place<F> on_tube(const Vector3<F> &p) {
  constexpr float pi = 3.14159265358979323846f;
  const F zero(0.0f), half(0.5f);
  return select((p.x == zero) & (p.y == zero), Place<F>{zero, zero},
                Place<F>{half - atan2(p.x, p.y) / F(2.0f * pi), half * (p.z + F(1.0f))});
}

// Returns the weights of a box's three sides for a normal with n.x + n.y + n.z = 1, all positive. In the triangle with the
// sides as corners there is one image near a corner, a mix of two near an edge, and a mix of three in the middle.
template <class F> Vector3<F> box_shares(const Vector3<F> &n, const F &blend) {
  using V3 = Vector3<F>;
  const F zero(0.0f), one(1.0f), half(0.5f), two(2.0f), limit = half * (one + blend);
  V3 shares = (F(two - limit) * n + V3(limit - one)) / F(two * limit - one);
  // Omit side `out` if the other two are far larger: side i then has the returned share, and side j the rest.
  const auto edge = [&](const F &out, const F &i, const F &j, F &of_i) {
    of_i = clamp01(F((i / (i + j) - half * (one - blend)) / blend));
    return out < (one - limit) * (i + j);
  };
  F share;
  // The first match wins: z, x, y omitted.
  auto only = edge(n.y, n.x, n.z, share);
  shares = select(only, V3(share, zero, one - share), shares);
  only = edge(n.x, n.y, n.z, share);
  shares = select(only, V3(zero, share, one - share), shares);
  only = edge(n.z, n.x, n.y, share);
  shares = select(only, V3(share, one - share, zero), shares);
  shares = select(blend > zero, shares, V3(one, zero, zero));
  const auto alone = [&](const F &i, const F &j, const F &k) { return (i > limit * (i + j)) & (i > limit * (i + k)); };
  shares = select(alone(n.z, n.x, n.y), V3(zero, zero, one), shares);
  shares = select(alone(n.y, n.z, n.x), V3(zero, one, zero), shares);
  return select(alone(n.x, n.y, n.z), V3(one, zero, zero), shares);
}

// Returns the places on a box's sides, oriented so that no image is mirrored. n: outwards.
template <class F, class N> void box_places(const Vector3<N> &p, const Vector3<F> &n, Place<N> (&places)[3]) {
  const F zero(0.0f);
  const N one(1.0f);
  places[0] = {select(n.x < zero, one - p.y, p.y), p.z};
  places[1] = {select(n.y > zero, one - p.x, p.x), p.z};
  places[2] = {select(n.z > zero, one - p.y, p.y), p.x};
}

template <class F> Value<F> box(const ProgramView &program, const Inputs<F> &in, const Site<F> &site, const ImageView &image) {
  const F zero(0.0f), one(1.0f);
  const Vector3<F> n = normal_to_object(site, site.ns), size = abs(n);
  const F sum = size.x + size.y + size.z;
  const Vector3<F> unit = select(sum > zero, size / sum, Vector3<F>(one, zero, zero));
  const Vector3<F> shares = box_shares(unit, in.scalar(1));
  Place<F> places[3];
  if (in.node.mipmapped) {
    Place<Dual<F>> changing[3];
    box_places(ChangingInputs<F>{program, in, in.node}[0], n, changing);
    for (int i = 0; i < 3; ++i)
      places[i] = squared(changing[i]);
  } else {
    box_places(in[0], n, places);
  }
  const F share[3] = {shares.x, shares.y, shares.z};
  Value<F> result = nothing<F>();
  for (int i = 0; i < 3; ++i) {
    const auto shown = share[i] > zero;
    if (!any(shown))
      continue;
    const Value<F> side =
        in.node.flags & kTileOfEachSide ? look_up_tile(in, site, places[i]) : look_up(in, site, image, places[i]);
    const Value<F> more{result.v + share[i] * side.v, result.alpha + share[i] * side.alpha};
    result = select(shown, more, result);
  }
  return result;
}

// Looks up the side of a cube through which a direction leaves. The sides are upright as seen from inside with +z up; +z and -z
// are as seen by a viewer who faces +y and then looks up or down.
template <class F> Value<F> cube(const Inputs<F> &in, const Site<F> &site, const Vector3<F> &d) {
  using U = WordOf<F>;
  const F zero(0.0f), half(0.5f);
  const Vector3<F> size = abs(d);
  const MaskOf<F> x = (size.x >= size.y) & (size.x >= size.z), y = (!x) & (size.y >= size.z);
  const F along = select(x, d.x, select(y, d.y, d.z)), length = abs(along);
  const auto negative = along < zero;
  const U side = select(x, U(0u), select(y, U(2u), U(4u))) + select(negative, U(1u), U(0u));
  const F sign = select(negative, F(-1.0f), F(1.0f));
  const F right = select(x, F(-sign * d.y), select(y, F(sign * d.x), d.x));
  const F up = select(x | y, d.z, F(-sign * d.y));
  const Place<F> place{half + half * right / length, half + half * up / length};
  const auto nowhere = (length == zero) & by_lane<MaskOf<F>>([&](int i) { return lane(side, i) < in.node.image_count; });
  return select(nowhere, nothing<F>(), look_up_each(in, site, side, place));
}

template <class N> Place<N> projected(uint32_t projection, const Vector3<N> &p) {
  const Vector3<N> around = N(2.0f) * p - Vector3<N>(N(1.0f));
  return projection == ImageProjection::Sphere ? on_sphere(around)
         : projection == ImageProjection::Tube ? on_tube(around)
                                               : Place<N>{p.x, p.y};
}

template <class F> Value<F> image_node(const ProgramView &program, const Inputs<F> &in, const Site<F> &site) {
  if (in.node.image_count == 0)
    return missing<F>();
  const ImageView &first = picture(in, 0);
  if (in.node.option == ImageProjection::Box)
    return box(program, in, site, first);
  const Place<F> place = in.node.mipmapped ? squared(projected(in.node.option, ChangingInputs<F>{program, in, in.node}[0]))
                                           : projected(in.node.option, in[0]);
  return first.tile != 0 ? look_up_tile(in, site, place) : look_up(in, site, first, place);
}

// The mirror ball is seen along +y. The normal that mirrors the view to d is halfway between the viewer and d.
template <class N> Place<N> on_mirror_ball(const Vector3<N> &d) {
  const N zero(0.0f), one(1.0f), half(0.5f);
  const N size = N(2.0f) * sqrt(max(N(-0.5f) * (d.y - one), zero)), length = select(size > zero, size, one);
  return {half * (d.x / length + one), half * (d.z / length + one)};
}

template <class F> Value<F> environment_node(const ProgramView &program, const Inputs<F> &in, const Site<F> &site) {
  using D = DoubleOf<F>;
  const Vector3<F> given = in[0];
  if (in.node.option == EnvironmentProjection::Cube)
    return cube(in, site, unit_or_zero(given));
  if (in.node.image_count == 0)
    return missing<F>();
  const F zero(0.0f);
  const bool is_ball = in.node.option == EnvironmentProjection::MirrorBall;
  Place<F> place;
  if (is_ball) {
    place = on_mirror_ball(unit_or_zero(given));
  } else {
    const Vector3<D> d = widen(given);
    const MapPlace<D> seen = place_on_map(d.x, d.y, d.z, D(sqrt(d.x * d.x + d.y * d.y)));
    place = select(black(given), Place<F>{zero, zero}, Place<F>{narrow(D(0.5) - seen.x), narrow(D(0.5) + seen.y)});
  }
  if (in.node.mipmapped) {
    // Longitudes are those of a sphere around another axis, and change as much.
    const Vector3<Dual<F>> d = ChangingInputs<F>{program, in, in.node}[0];
    const Place<F> changing = squared(is_ball ? on_mirror_ball(unit_or_zero(d)) : on_sphere(Vector3<Dual<F>>(d.y, d.x, d.z)));
    place.u2 = changing.u2;
    place.v2 = changing.v2;
  }
  return look_up(in, site, picture(in, 0), place);
}

} // namespace
} // namespace lancer
