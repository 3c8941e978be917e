// Exact surfaces: accuracy of t, starts on the surface, closed rims, and projection onto the surface.
#include "accel/hit_tests.h"
#include "accel_scenes.h"
#include "quad.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

Quad quad_sqrt(Quad x) {
  Quad r = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 3 && r > 0; ++i)
    r = (r + x / r) / 2; // each Newton step doubles the digits
  return r;
}

struct Reference {
  bool hit;
  double t, cosine; // first root, and |cosine| of its angle of incidence
};

// Returns the first root of |o + t d - c| = r in 113 bits. Differences of doubles up to 2^40 apart and their products are exact
// or nearly so: the error is 2^-50 of double's.
Reference reference_sphere(const Ray &ray, const glm::dvec3 &centre, double radius, bool second) {
  Quad a = 0, b = 0, c = -static_cast<Quad>(radius) * radius;
  for (int i = 0; i < 3; ++i) {
    const Quad f = static_cast<Quad>(ray.o[i]) - centre[i], d = ray.d[i];
    a += d * d;
    b -= f * d;
    c += f * f;
  }
  const Quad discriminant = b * b - a * c;
  if (discriminant < 0)
    return {false, 0.0, 0.0};
  const Quad root = quad_sqrt(discriminant);
  const Quad t = ((second ? b + root : b - root)) / a;
  return {true, static_cast<double>(t), static_cast<double>(root / (quad_sqrt(a) * static_cast<Quad>(radius)))};
}

PlacedShape unit_shape(ShapeKind kind) {
  PlacedShape shape{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 0}}, {}, 0x1p-46, kind, kNone, 0, 0, 0};
  return shape;
}

// In the sphere's own frame t keeps nearly all digits at any distance of the viewer: u is 2^-53. c is exact to 2u; o x d and a
// round to some 8u, which moves q by a relative 8u / cos^2; then two more roundings.
TEST(Quadric, SphereKeepsTheDigitsNextToTheSurface) {
  Random random(21);
  const PlacedShape sphere = unit_shape(ShapeKind::Sphere);
  int checked = 0;
  for (int i = 0; i < 100000; ++i) {
    const double height = std::exp2(random.uniform(-45.0, 3.0));
    const glm::dvec3 n = random.direction();
    const Ray ray = make_ray(n * (1.0 + height), random.direction());
    const Reference e = reference_sphere(ray, glm::dvec3(0.0), 1.0, false);
    if (!e.hit || e.t <= 0.0 || e.cosine < 1e-5)
      continue;
    double t;
    ASSERT_TRUE(intersect_quadric(sphere, ray, false, t));
    ASSERT_NEAR(t, e.t, 16 * 0x1p-53 * (1.0 + 1.0 / (e.cosine * e.cosine)) * e.t) << "height " << height;
    ++checked;
  }
  EXPECT_GT(checked, 10000);
}

// Through a placement the origin itself has an error of some u (|o| + |c| + r) per coordinate: three products, three sums, the
// rounded matrix: 6u, in length 6 sqrt(3) u < 11u, more along a slanted surface by 1 / cos. t and d add a few u of t.
void expect_accurate(double radius, const glm::dvec3 &centre, double least_height, double greatest_height, uint64_t seed) {
  Random random(seed);
  Geometry geometry;
  geometry.instances.push_back(placed(ShapeKind::Sphere, glm::dmat3(radius), centre));
  const auto accelerator = build_accelerator(AcceleratorKind::Bvh, geometry, {});
  int checked = 0;
  for (int i = 0; i < 20000; ++i) {
    const double height = radius * std::exp2(random.uniform(std::log2(least_height), std::log2(greatest_height)));
    const glm::dvec3 o = centre + random.direction() * (radius + height);
    const glm::dvec3 aim = centre + random.direction() * (radius * random.uniform(0.0, 1.0));
    const Ray ray = make_ray(o, (i & 1) ? aim - o : random.direction() * radius);
    const Reference e = reference_sphere(ray, centre, radius, false);
    if (!e.hit || e.t <= 0.0 || e.cosine < 1e-4)
      continue;
    const double length = glm::length(ray.d);
    const double error =
        16 * 0x1p-53 * (glm::length(o) + glm::length(centre) + radius) / (e.cosine * length) + 8 * 0x1p-53 * e.t;
    const Hit hit = closest(*accelerator, ray);
    ASSERT_TRUE(hit.valid());
    ASSERT_NEAR(hit.t, e.t, error) << "height " << height;
    ++checked;
  }
  EXPECT_GT(checked, 5000);
}

TEST(Quadric, SphereOfAnySize) {
  expect_accurate(1.0, {1, 2, 3}, 1e-6, 1e3, 22);
  expect_accurate(1e9, {0, 0, -1e9}, 1e-9, 1e-3, 23);
  expect_accurate(1e-6, {0.5, 0, 0}, 1e-3, 1e6, 24);
  expect_accurate(1e9, {1e9, 1e9, 1e9}, 1e-9, 1.0, 25);
}

// A ray that starts on the surface does not hit it again at once; inwards it hits the far side, outwards nothing.
TEST(Quadric, StartIsNotMetAgain) {
  Random random(26);
  for (const ShapeKind kind : {ShapeKind::Sphere, ShapeKind::Cylinder, ShapeKind::Cone})
    for (int scene = 0; scene < 40; ++scene) {
      const double scale = std::exp2(random.uniform(-20.0, 30.0));
      glm::dmat3 linear;
      do {
        for (int column = 0; column < 3; ++column)
          linear[column] = random.in_box(1.0);
      } while (std::abs(glm::determinant(linear)) < 0.1);
      Geometry geometry;
      geometry.instances.push_back(placed(kind, linear * scale, random.in_box(scale * std::exp2(random.uniform(-2.0, 20.0)))));
      const Instance &instance = geometry.instances[0];
      const auto accelerator = build_accelerator(AcceleratorKind::BruteForce, geometry, {});
      for (int i = 0; i < 500; ++i) {
        const glm::dvec3 from = random.in_box(3.0);
        const Ray towards = make_ray(instance.to_world.point(from), instance.to_world.vector(random.in_box(0.5) - from));
        const Hit first = closest(*accelerator, towards);
        if (!first.valid())
          continue;
        const SurfacePoint s =
            quadric_point(kind, instance.to_object.point(towards.o), instance.to_object.vector(towards.d), first.t);
        const glm::dvec3 away = random.direction();
        Ray ray = make_ray(instance.to_world.point(s.p), instance.to_world.vector(away));
        ray.skip_instance = ray.skip_primitive = 0;
        const Hit next = closest(*accelerator, ray);
        if (glm::dot(away, s.n) > 1e-3) {
          // Convex: the line has left for good.
          ASSERT_FALSE(next.valid()) << "kind " << static_cast<int>(kind) << " t " << next.t;
        } else if (kind == ShapeKind::Sphere && glm::dot(away, s.n) < -1e-3) {
          // The chord has length 2 cos; the start and the placement have the error of placed_scene.cpp's slack, 2^-48 of their
          // magnitudes, here at most 2^22 / 0.02 of the radius.
          ASSERT_TRUE(next.valid());
          ASSERT_NEAR(next.t, -2.0 * glm::dot(away, s.n), 0x1p-48 * 0x1p28 / -glm::dot(away, s.n));
        } else if (glm::dot(away, s.n) < -1e-3) {
          ASSERT_TRUE(next.valid()) << "kind " << static_cast<int>(kind);
          ASSERT_GT(next.t, 0.0);
        }
      }
    }
}

// Rays from inside at the rims, the apex and everywhere else: the surface is closed.
TEST(Quadric, ClosedAtTheRims) {
  Random random(27);
  for (const ShapeKind kind : {ShapeKind::Sphere, ShapeKind::Cylinder, ShapeKind::Cone}) {
    const PlacedShape shape = unit_shape(kind);
    for (int i = 0; i < 100000; ++i) {
      const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      const glm::dvec3 rim(std::cos(angle), std::sin(angle), kind == ShapeKind::Cylinder && (i & 1) ? 1.0 : -1.0);
      const glm::dvec3 aim = i % 3 == 0 ? glm::dvec3(0, 0, 1) : rim;
      const glm::dvec3 o(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.9, 0.0));
      double t;
      ASSERT_TRUE(intersect_quadric(shape, make_ray(o, aim - o), false, t)) << static_cast<int>(kind);
      // The target is on the surface or, for the sphere, outside it.
      ASSERT_LE(t, 1.0 + 0x1p-40);
      ASSERT_GT(t, 0.0);
    }
  }
}

// Hits are on the surface: residuals of the defining equations, and the normal is their gradient.
TEST(Quadric, PointsLieOnTheSurface) {
  Random random(28);
  for (const ShapeKind kind : {ShapeKind::Sphere, ShapeKind::Cylinder, ShapeKind::Cone, ShapeKind::Plane}) {
    const PlacedShape shape = unit_shape(kind);
    int met = 0;
    for (int i = 0; i < 100000; ++i) {
      const Ray ray = make_ray(random.in_box(3.0), random.direction());
      double t;
      if (!intersect_quadric(shape, ray, false, t))
        continue;
      ++met;
      const SurfacePoint s = quadric_point(kind, ray.o, ray.d, t);
      const double r = std::hypot(s.p.x, s.p.y);
      double residual = s.p.z; // PLANE
      if (kind == ShapeKind::Sphere)
        residual = glm::length(s.p) - 1.0;
      else if (kind == ShapeKind::Cylinder)
        residual = std::max(r - 1.0, std::abs(s.p.z) - 1.0);
      else if (kind == ShapeKind::Cone)
        residual = std::max(r - 0.5 * (1.0 - s.p.z), -1.0 - s.p.z);
      // One scaling and one length: 4 ulp.
      ASSERT_NEAR(residual, 0.0, 4 * 0x1p-52);
      // The ray's own point has the rounding error of o + t d and of t, divided by |cos|; coordinates are below 8.
      const double cosine = std::abs(glm::dot(ray.d, s.n));
      ASSERT_LE(glm::length(s.p - (ray.o + t * ray.d)), 64 * 0x1p-52 * (1.0 + 1.0 / (cosine * cosine)));
      ASSERT_NEAR(glm::length(s.n), 1.0, 4 * 0x1p-52);
      if (kind == ShapeKind::Sphere)
        ASSERT_EQ(s.n, s.p);
      else if (kind == ShapeKind::Plane)
        ASSERT_EQ(s.n, glm::dvec3(0, 0, 1));
      else if (std::abs(s.p.z) < 0.999 && r > 1e-3) {
        const double slope = kind == ShapeKind::Cone ? 0.5 : 0.0;
        ASSERT_NEAR(s.n.z, slope * glm::length(glm::dvec2(s.n)), 8 * 0x1p-52);
        ASSERT_NEAR(glm::dot(glm::dvec2(s.n), glm::dvec2(s.p)), r * glm::length(glm::dvec2(s.n)), 8 * 0x1p-52);
      }
      if (kind == ShapeKind::Plane)
        continue;
      const glm::dvec2 uv = quadric_uv(kind, s.p);
      ASSERT_TRUE(uv.x >= 0.0 && uv.x < 1.0 && uv.y >= 0.0 && uv.y <= 1.0);
    }
    EXPECT_GT(met, 2000);
  }
}

// u turns counter-clockwise from x; v rises from -z to +z, by the latitude on a sphere.
TEST(Quadric, TextureCoordinatesRiseWithZ) {
  const double r = std::sqrt(0.5);
  for (const ShapeKind kind : {ShapeKind::Sphere, ShapeKind::Cylinder, ShapeKind::Cone}) {
    EXPECT_NEAR(quadric_uv(kind, {0.0, 0.5, 0.0}).x, 0.25, 1e-15);
    EXPECT_NEAR(quadric_uv(kind, {0.0, -0.5, 0.0}).x, 0.75, 1e-15);
    EXPECT_NEAR(quadric_uv(kind, {1.0, 0.0, 0.0}).y, 0.5, 1e-15);
    EXPECT_NEAR(quadric_uv(kind, {0.0, 0.0, 1.0}).y, 1.0, 1e-15);
    EXPECT_NEAR(quadric_uv(kind, {0.0, 0.0, -1.0}).y, 0.0, 1e-15);
  }
  EXPECT_NEAR(quadric_uv(ShapeKind::Sphere, {r, 0.0, r}).y, 0.75, 1e-15);
  EXPECT_EQ(quadric_uv(ShapeKind::Plane, {3.0, -2.0, 0.0}), glm::dvec2(3.0, -2.0));
}

} // namespace
} // namespace lancer::test
