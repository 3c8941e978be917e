// The Radial Tiling node: coordinates within the segments of a polygon with any number of sides, the last of which may be
// narrower, and with round corners.
#pragma once

#include "sampling/elementary.h"
#include "simd/vectors.h"

namespace lancer {

// Angles are counterclockwise. A segment reaches from one corner of the polygon to the next; its bisector is perpendicular to
// its side, at distance 1 from the origin.

// The rounding of a segment: start is the angle from the corner to the side's straight part, rest from there to the bisector,
// spline the part of start over which the coordinate along the side changes from that of the side to that of the circle.
template <class F> struct Bevel { F start, rest, roundness, spline; };

template <class F> LANCER_LANE Bevel<F> bevel_of(const F &half_angle, const F &roundness) {
  // Without roundness the tangent and its inverse cancel; that of a right angle would not.
  const F straight = F(1.0f) - roundness, bent = atan(F(straight * tan(half_angle)));
  const F rest = select(roundness == F(0.0f), half_angle, bent), start = half_angle - rest;
  return {start, rest, roundness, straight * start};
}
template <class F> LANCER_LANE Bevel<F> select(const MaskOf<F> &m, const Bevel<F> &a, const Bevel<F> &b) {
  return {select(m, a.start, b.start), select(m, a.rest, b.rest), select(m, a.roundness, b.roundness),
          select(m, a.spline, b.spline)};
}

// Returns half the length of a polygon's side: at distance l along the bisector, and for a place at distance l from the origin.
template <class F> LANCER_LANE F half_side(const Bevel<F> &bevel, const F &l) {
  const F half(0.5f);
  return l * tan(bevel.rest) + bevel.spline * (half * l + half) + bevel.roundness * bevel.start;
}
template <class F> LANCER_LANE F half_side_around(const Bevel<F> &bevel, const F &l) {
  const F half(0.5f);
  return l * sin(bevel.rest) + bevel.spline * (half * l * cos(bevel.rest) + half) + bevel.roundness * bevel.start;
}
// Returns the distance from the bisector along a rounded side. from_straight: angle from the end of the straight part.
template <class F> LANCER_LANE F along_round_side(const Bevel<F> &bevel, const F &l, const F &from_straight) {
  const F half(0.5f), one(1.0f), straight = l * cos(bevel.rest);
  const F within = straight * from_straight + half * (one - straight) * from_straight * from_straight / bevel.spline;
  const F beyond = bevel.spline * (half * straight - half) + from_straight;
  return l * sin(bevel.rest) + select(from_straight < bevel.spline, within, beyond);
}

// Returns the distance from the origin, in direction (cos, sin), to the far side of a circle.
template <class F> LANCER_LANE F far_side(const SinCos<F> &direction, const Vector2<F> &centre, const F &radius) {
  const F along = direction.sin * centre.y + direction.cos * centre.x;
  return along + sqrt(along * along + radius * radius - centre.x * centre.x - centre.y * centre.y);
}

// Coordinates along the side and along the bisector; the segment's width, and the angle of its bisector.
template <class F> struct Tile { F along, distance, width, turn; };

// The node RADIAL_TILING, option 0.
template <class F>
static Tile<F> radial_tile(const F &x, const F &y, const F &given_sides, const F &given_roundness, bool normalizes) {
  const F zero(0.0f), one(1.0f), two(2.0f), half(0.5f), pi(3.14159265358979323846f), turn(6.28318530717958647692f);
  const F sides = max(given_sides, two), roundness = min(one, max(zero, given_roundness));
  const F length = sqrt(x * x + y * y), direction = atan2(y, x), theta = direction + select(y < zero, turn, zero);

  // Find the segment, and the angle within it.
  const F angle = pi / sides, segment = floor(theta / (two * angle)), within = theta - segment * (two * angle);
  const Bevel<F> regular = bevel_of(angle, roundness);
  // The last segment and the corners at its ends.
  const F last = pi - floor(sides) * angle, last_begin = turn - two * last, ratio = cos(angle) / cos(last);
  const Bevel<F> inner = bevel_of(last, roundness);
  const F radius = roundness * tan(last) / tan(F(half * (angle + last))), to_side = cos(inner.rest);
  const Vector2<F> centre{cos(inner.start) / to_side - radius * cos(last), radius * sin(last) - sin(inner.start) / to_side};
  const F outer_start = atan(F((centre.y + radius * sin(angle)) / (centre.x + radius * cos(angle))));
  const F outer_roundness = one - tan(F(angle - outer_start)) / tan(angle);
  const Bevel<F> outer{outer_start, angle - outer_start, outer_roundness, (one - outer_roundness) * outer_start};

  // Choose the side that the place belongs to: one of a whole segment, or of the last; and its straight or its round part.
  const MaskOf<F> is_whole = sides == floor(sides), is_broken = sides != floor(sides);
  const MaskOf<F> at_regular = is_whole | ((theta >= outer_start) & (theta < last_begin - outer_start));
  const MaskOf<F> in_middle = (within >= regular.start) & (within < two * angle - regular.start);
  const MaskOf<F> at_ends = is_broken & ((theta >= last_begin - regular.start) | (theta < regular.start));
  const MaskOf<F> on_last = (theta >= last_begin + inner.start) & (theta < turn - inner.start);
  const MaskOf<F> before_last = (theta >= last_begin - outer_start) & (theta < turn - last);
  const F from_end = select(before_last, -(direction + two * last), direction);
  const MaskOf<F> is_irregular = !at_regular, is_last = is_irregular & (on_last | (from_end < zero));
  const MaskOf<F> is_outer = is_irregular & (!is_last);
  const MaskOf<F> is_straight = (at_regular & (in_middle | at_ends)) | (is_irregular & on_last);
  const MaskOf<F> is_beside = at_regular & is_broken & is_straight & ((theta >= last_begin - angle) | (theta < angle));
  const Bevel<F> bevel = select(is_last, inner, select(is_outer | is_beside, outer, regular));
  const F bisector = select(is_last, last, angle), scale = select(is_last, ratio, one);

  // Measure along the bisector, for a round part in units of the distance of its circle.
  const F nearest = select(at_regular, within - select(within > angle, two * angle, zero), from_end);
  const Vector2<F> middle{select(at_regular, (one - roundness) / cos(angle), centre.x), select(at_regular, zero, centre.y)};
  const F to_circle = far_side<F>({sin(nearest), cos(nearest)}, middle, select(at_regular, roundness, radius));
  const F own = select(is_straight, length * cos(F(bisector - within)), length / to_circle);
  const F distance = select(at_regular, own, ratio * own), measured = select(is_outer, distance, own);

  // Measure along the side.
  const F from_straight = bevel.start - abs(nearest);
  const F away = select(is_straight, own * tan(abs(F(bisector - within))), along_round_side(bevel, length, from_straight));
  const F side = half_side(bevel, measured), around = half_side_around(bevel, length);
  const F whole_side = scale * select(is_straight, side, side + from_straight / bevel.start * (around - side));
  const F last_width = tan(inner.rest) + ratio * (inner.spline * (half / ratio + half) + inner.roundness * inner.start);
  const F width = select(is_last, last_width, half_side(regular, one));
  // Two straight sides are parallel and have no end.
  const MaskOf<F> is_endless = (sides == two) & (roundness == zero);
  const F signed_away = scale * select(within < bisector, -away, away);
  const F share = select(is_endless, signed_away, signed_away / whole_side);
  const F along = select((x == zero) & (y == zero), zero, normalizes ? share : signed_away);
  return {normalizes ? half * along + half : along, normalizes ? distance : distance - one, select(is_endless, zero, width),
          segment * (two * angle) + bisector};
}

// The node RADIAL_TILING, option 1: the number of the segment.
template <class F> LANCER_LANE F radial_segment(const F &x, const F &y, const F &sides) {
  const F turns = atan2(y, x) / F(6.28318530717958647692f);
  return floor(max(sides, F(2.0f)) * (turns + select(y < F(0.0f), F(1.0f), F(0.0f))));
}

} // namespace lancer
