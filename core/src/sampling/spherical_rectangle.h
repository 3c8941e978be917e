// Samples a rectangle uniformly in solid angle. D is double or lanes of it.
#pragma once

#include "sampling/angle.h"
#include "simd/vectors.h"

#include <numbers>

namespace lancer {

// The rectangle low <= (x, y) <= high of the plane at z > 0, seen from the origin.
template <class D> struct SphericalRectangle {
  Vector2<D> low, high;
  D z, solid_angle;

  LANCER_LANE SphericalRectangle(const Vector2<D> &low_, const Vector2<D> &high_, const D &z_) : low(low_), high(high_), z(z_) {
    // The solid angle is that up to high.x minus that up to low.x.
    left_ = between(low.x);
    solid_angle = between(high.x) - left_;
  }

  // Returns the point of the plane hit by a direction of density 1 / solid_angle (Urena, Fajardo, King, "An area-preserving
  // parametrization for spherical rectangles", 2013). solid_angle must exceed its rounding error.
  LANCER_LANE Vector2<D> sample(const D &u, const D &v) const {
    const D zero(0.0);
    // Cut the rectangle at the x below which lies the share u of the solid angle.
    const SinCos<D> cut = sin_cos_turn(wrapped((u * solid_angle + left_) * D(0.5 * std::numbers::inv_pi)));
    // n.z of the planes through the lower and upper sides; the angles there are those of the cut.
    const D over_low = sqrt(z * z + low.y * low.y), over_high = sqrt(z * z + high.y * high.y);
    const D b0 = -low.y / over_low, b1 = high.y / over_high;
    const D along = cut.cos * b0 + b1, tilt = z / over_low;
    const D apart2 = (along - tilt * cut.sin) * (along + tilt * cut.sin);
    const D signed_sin = select(along < zero, -cut.sin, cut.sin);
    const D limit = select(signed_sin < zero, low.x, high.x);
    const D found = select(apart2 > zero, z * signed_sin / sqrt(max(apart2, D(0x1p-1000))), limit);
    const D x = min(max(found, low.x), high.x);
    // Along the cut, the solid angle is linear in the sine of the elevation above the plane's horizon.
    const D d2 = x * x + z * z;
    const D h0 = low.y / sqrt(d2 + low.y * low.y), h1 = high.y / sqrt(d2 + high.y * high.y);
    const D h = h0 + v * (h1 - h0), cos2 = (D(1.0) - h) * (D(1.0) + h);
    const D y = select(cos2 > zero, h * sqrt(d2 / max(cos2, D(0x1p-1000))), high.y);
    return {x, min(max(y, low.y), high.y)};
  }

private:
  D left_; // solid angle up to low.x, which is also the angle of the cut there

  // Returns the solid angle of the part from the foot of the origin up to x, with the sign of x. The rectangle from the foot to
  // (x, y) has the angle of a complex number (z sqrt(x^2 + y^2 + z^2), x y); the part has the angle of a quotient of two.
  LANCER_LANE D between(const D &x) const {
    const D low_sin = x * low.y, low_cos = z * sqrt(x * x + low.y * low.y + z * z);
    const D high_sin = x * high.y, high_cos = z * sqrt(x * x + high.y * high.y + z * z);
    return angle(high_sin * low_cos - high_cos * low_sin, high_cos * low_cos + high_sin * low_sin);
  }
  // Maps turns from -1 ... 1 to 0 ... 1.
  static LANCER_LANE D wrapped(const D &turns) { return select(turns < D(0.0), turns + D(1.0), turns); }
};

} // namespace lancer
