// Precision of t on exact surfaces: spheres, cylinders, cones and planes of any size, from close by and at grazing angles.
#include "accel_scenes.h"
#include "quad.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

Quad root_of(Quad x) {
  if (!(x > 0))
    return 0;
  // Start in double; each Newton step doubles the digits.
  Quad r = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 3; ++i)
    r = (r + x / r) / 2;
  return r;
}

struct Quad3 {
  Quad x, y, z;
};
Quad dot(const Quad3 &a, const Quad3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Quad3 at(const Quad3 &o, const Quad3 &d, Quad t) { return {o.x + t * d.x, o.y + t * d.y, o.z + t * d.z}; }

struct Place {
  Quad t;
  Quad3 n; // outward, of any length, in the shape's space
};

// Adds the roots of a t^2 + 2 b t + c = 0, or of the line b t + c = 0.
void add_roots(std::vector<Quad> &roots, Quad a, Quad b, Quad c) {
  const Quad discriminant = b * b - a * c;
  if (discriminant < 0)
    return;
  const Quad q = -(b + (b < 0 ? -root_of(discriminant) : root_of(discriminant)));
  if (q != 0)
    roots.push_back(c / q);
  if (a != 0)
    roots.push_back(q / a);
}

// Finds the first t > 0 where o + t d hits the surface in its own space, in 113 bits.
bool reference(ShapeKind kind, const Quad3 &o, const Quad3 &d, Place &first) {
  std::vector<Place> places;
  const auto keep = [&](Quad t, auto &&normal, auto &&inside) {
    const Quad3 p = at(o, d, t);
    if (inside(p))
      places.push_back({t, normal(p)});
  };
  const auto everywhere = [](const Quad3 &) { return true; };
  const auto cap = [&](Quad z) {
    if (d.z != 0)
      keep((z - o.z) / d.z,
           [z](const Quad3 &) {
             return Quad3{0, 0, z};
           },
           [](const Quad3 &p) { return p.x * p.x + p.y * p.y <= 1; });
  };
  std::vector<Quad> roots;
  if (kind == ShapeKind::Plane && d.z != 0)
    keep(
        -o.z / d.z,
        [](const Quad3 &) {
          return Quad3{0, 0, 1};
        },
        everywhere);
  if (kind == ShapeKind::Sphere) {
    add_roots(roots, dot(d, d), dot(o, d), dot(o, o) - 1);
    for (const Quad t : roots)
      keep(
          t, [](const Quad3 &p) { return p; }, everywhere);
  }
  if (kind == ShapeKind::Cylinder) {
    add_roots(roots, d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y, o.x * o.x + o.y * o.y - 1);
    for (const Quad t : roots)
      keep(
          t,
          [](const Quad3 &p) {
            return Quad3{p.x, p.y, 0};
          },
          [](const Quad3 &p) { return p.z >= -1 && p.z <= 1; });
    cap(1);
    cap(-1);
  }
  if (kind == ShapeKind::Cone) {
    const Quad w = 1 - o.z;
    add_roots(roots, d.x * d.x + d.y * d.y - d.z * d.z / 4, o.x * d.x + o.y * d.y + w * d.z / 4,
              o.x * o.x + o.y * o.y - w * w / 4);
    for (const Quad t : roots)
      keep(
          t,
          [](const Quad3 &p) {
            return Quad3{p.x, p.y, (1 - p.z) / 4};
          },
          [](const Quad3 &p) { return p.z >= -1 && p.z <= 1; });
    cap(-1);
  }
  bool found = false;
  for (const Place &place : places)
    if (place.t > 0 && (!found || place.t < first.t)) {
      first = place;
      found = true;
    }
  return found;
}

glm::dvec3 normal_at(ShapeKind kind, const glm::dvec3 &p) {
  const glm::dvec2 out = glm::normalize(glm::dvec2(p));
  if (kind == ShapeKind::Plane)
    return {0, 0, 1};
  return kind == ShapeKind::Sphere ? p : glm::normalize(glm::dvec3(out, kind == ShapeKind::Cone ? 0.5 : 0.0));
}

// Returns a point on the curved side, away from rims and apex.
glm::dvec3 point_on(ShapeKind kind, Random &random) {
  if (kind == ShapeKind::Sphere)
    return random.direction();
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi), z = random.uniform(-0.9, 0.9);
  if (kind == ShapeKind::Plane)
    return {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.0};
  const double radius = kind == ShapeKind::Cone ? 0.5 * (1.0 - z) : 1.0;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

// Errors in units of an ulp times the condition number. A relative change of o, the centre, the size or d by eps moves the line
// against the surface by eps (|o| + |c| + r |p| + t |d|), and along the line by this over |cosine|.
struct Worst {
  double ulps = 0.0;
  size_t checked = 0, missed = 0;
};

Worst measure(ShapeKind kind, uint64_t seed, bool grazing, double far) {
  Random random(seed);
  Worst worst;
  for (int scene = 0; scene < 40; ++scene) {
    const double r = std::pow(10.0, random.uniform(-6.0, 9.0));
    const glm::dvec3 centre = random.in_box(far * r);
    Geometry geometry;
    geometry.instances.push_back(placed(kind, glm::dmat3(r), centre));
    const auto accelerator = build_accelerator(AcceleratorKind::Bvh, geometry, {});
    for (int i = 0; i < 300; ++i) {
      // From a height of 1e-9 of the radius, or from farther away.
      const glm::dvec3 on = point_on(kind, random), n = normal_at(kind, on);
      const glm::dvec3 o = centre + r * (on + n * std::pow(10.0, random.uniform(-9.0, i & 1 ? -8.0 : 1.0)));
      const glm::dvec3 along = glm::normalize(glm::cross(n, random.direction()));
      glm::dvec3 d = grazing ? along - n * std::pow(10.0, random.uniform(-6.0, -3.0)) : centre + r * point_on(kind, random) - o;
      if (!grazing && (i & 2))
        d = random.direction();
      const Quad3 qo{(Quad(o.x) - centre.x) / r, (Quad(o.y) - centre.y) / r, (Quad(o.z) - centre.z) / r};
      const Quad3 qd{Quad(d.x) / r, Quad(d.y) / r, Quad(d.z) / r};
      Place want;
      if (!reference(kind, qo, qd, want))
        continue;
      const Quad3 p = at(qo, qd, want.t);
      const double cosine = std::abs(static_cast<double>(dot(want.n, qd) / root_of(dot(want.n, want.n) * dot(qd, qd))));
      const double t = static_cast<double>(want.t), length = glm::length(d);
      const double reach = glm::length(o) + glm::length(centre) + r * static_cast<double>(root_of(dot(p, p))) + t * length;
      const double unit = 0x1p-52 * reach / (cosine * length);
      // Skip rays for which rounding may decide whether there is a hit.
      if (!(unit * 64.0 < cosine * r / length))
        continue;
      const Hit hit = closest(*accelerator, make_ray(o, d));
      ++worst.checked;
      worst.missed += !hit.valid();
      if (hit.valid())
        worst.ulps = std::max(worst.ulps, static_cast<double>((Quad(hit.t) > want.t ? hit.t - want.t : want.t - hit.t)) / unit);
    }
  }
  return worst;
}

TEST(Precision, FourUlpsTimesTheConditionNumber) {
  for (const ShapeKind kind : {ShapeKind::Sphere, ShapeKind::Plane, ShapeKind::Cylinder, ShapeKind::Cone})
    for (const bool grazing : {false, true})
      for (const double far : {0.0, 1.0, 1e6}) {
        const Worst worst = measure(kind, 71, grazing, far);
        EXPECT_LE(worst.ulps, 4.0) << static_cast<int>(kind) << grazing << far;
        EXPECT_EQ(worst.missed, 0u) << static_cast<int>(kind) << grazing << far;
        EXPECT_GT(worst.checked, 1000u) << static_cast<int>(kind) << grazing << far;
      }
}

} // namespace
} // namespace lancer::test
