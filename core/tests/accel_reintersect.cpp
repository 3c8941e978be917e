// A ray that leaves a surface hits neither this surface nor anything beside or below it.
#include "accel_scenes.h"
#include "quad.h"

#include "scene/surface.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

// Returns the height of p above the plane through a, b, c, times the length of their normal, in 113 bits: exact for floats up
// to 2^30 apart.
double above(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c, const glm::vec3 &p) {
  const auto minus = [](const glm::vec3 &u, const glm::vec3 &v, int i) { return Quad(u[i]) - Quad(v[i]); };
  Quad sum = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum += minus(p, a, i) * (minus(b, a, j) * minus(c, a, k) - minus(b, a, k) * minus(c, a, j));
  }
  return static_cast<double>(sum);
}

float signed_size(Random &random, double least, double most) {
  return float((random.below(2) ? 1.0 : -1.0) * std::pow(10.0, random.uniform(least, most)));
}

// Makes a triangle, with two neighbours at each corner and one at each edge, all of them below its plane.
bool ridge(Random &random, double least, double most, Mesh &mesh) {
  glm::vec3 v[3];
  for (glm::vec3 &corner : v)
    for (int i = 0; i < 3; ++i)
      corner[i] = signed_size(random, least, most);
  const glm::dvec3 a(v[0]), b(v[1]), c(v[2]), cross = glm::cross(b - a, c - a);
  const double area2 = glm::length(cross), longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  double largest = 0.0;
  for (const glm::vec3 &corner : v)
    largest = std::max(largest, largest_coordinate(glm::dvec3(corner)));
  // A line that starts a thousand times its length away, with a relative error of 2^-53, hits it at a sine of 1e-3 within 1e-10
  // of the target, which is at least a hundredth of its height inside.
  if (!(area2 / longest > 1e-7 * largest))
    return false;
  mesh = Mesh();
  mesh.positions = {v[0], v[1], v[2]};
  mesh.triangles = {{0, 1, 2}};
  const glm::dvec3 n = cross / area2, middle = (a + b + c) / 3.0;
  const auto add = [&](const glm::dvec3 &place) {
    const double fall = longest * std::pow(10.0, random.uniform(-4.0, 0.5));
    const glm::vec3 p(place - fall * n);
    if (!(above(v[0], v[1], v[2], p) < 0.0))
      return kNone;
    mesh.positions.push_back(p);
    return uint32_t(mesh.positions.size() - 1);
  };
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t k = (i + 1) % 3;
    const glm::dvec3 p(v[i]), q(v[k]);
    const uint32_t across = add(p + q - glm::dvec3(v[(i + 2) % 3])), left = add(2.0 * p - middle), right = add(2.0 * p - q);
    if (across == kNone || left == kNone || right == kNone)
      return false;
    mesh.triangles.insert(mesh.triangles.end(), {{k, i, across}, {i, left, right}, {i, right, across}});
  }
  return true;
}

// Returns whether no triangle is thinner than an eighth of its length L: its edge functions round by 2^-53 L^2, hence points on
// it by 2^-50 L, less than the 2^-49 L by which a ray is lifted off a surface. Near edges of thinner triangles this is not
// enough.
bool all_broad(const Mesh &mesh) {
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::dvec3 a = mesh.vertex(i, 0), b = mesh.vertex(i, 1), c = mesh.vertex(i, 2);
    const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    if (!(glm::length(glm::cross(b - a, c - a)) > 0.125 * longest * longest))
      return false;
  }
  return true;
}

TEST(Reintersect, RidgesOfAnySize) {
  Random random(91);
  size_t asked = 0, left = 0, broad_ones = 0;
  for (int scene = 0; scene < 20000; ++scene) {
    Geometry geometry;
    geometry.meshes.emplace_back();
    const double size = random.uniform(-8.0, 8.0);
    const bool mixed = random.below(2);
    if (!ridge(random, mixed ? -8.0 : size - 0.5, mixed ? 8.0 : size, geometry.meshes[0]))
      continue;
    const Mesh &mesh = geometry.meshes[0];
    glm::dmat3 linear(1.0);
    if (random.below(2))
      for (int column = 0; column < 3; ++column)
        linear[column] += random.in_box(0.5);
    geometry.instances.push_back(placed(ShapeKind::Mesh, linear, glm::dvec3(0.0)));
    const Affine &to_world = geometry.instances[0].to_world;
    const glm::dvec3 a = mesh.vertex(0, 0), b = mesh.vertex(0, 1), c = mesh.vertex(0, 2);
    const glm::dvec3 n =
        glm::normalize(glm::transpose(geometry.instances[0].to_object.linear) * glm::normalize(glm::cross(b - a, c - a)));
    const double size_here = glm::length(b - a) + glm::length(c - a);
    const bool broad = all_broad(mesh);
    broad_ones += broad;
    const auto accelerator = build_accelerator(scene % 2 ? AcceleratorKind::Bvh : AcceleratorKind::KdTree, geometry, {});
    for (int i = 0; i < 20; ++i) {
      // From above to the inside of the triangle, an edge or a corner, and away again to the same side.
      const bool inside = i % 4 < 2 || !broad;
      const double u = !inside && i % 4 == 3 ? 0.0 : random.uniform(0.01, 0.98),
                   v = inside ? random.uniform(0.01, 0.99 - u) : 0.0;
      const glm::dvec3 aim = to_world.point((1.0 - u - v) * a + u * b + v * c);
      glm::dvec3 from = random.direction(), away = random.direction();
      for (glm::dvec3 *d : {&from, &away})
        if (glm::dot(*d, n) < 0.0)
          *d -= 2.0 * glm::dot(*d, n) * n;
      if (random.below(2))
        away = glm::normalize(away - (glm::dot(away, n) - std::pow(10.0, random.uniform(-5.0, 0.0))) * n);
      if (!(glm::dot(from, n) > 1e-3) || !(glm::dot(away, n) > 1e-6))
        continue;
      const Ray ray = make_ray(aim + from * size_here * std::pow(10.0, random.uniform(-3.0, 3.0)), -from);
      const Hit hit = closest(*accelerator, ray);
      ++asked;
      if (inside) {
        ASSERT_TRUE(hit.valid()) << scene;
        ASSERT_EQ(hit.primitive, 0u) << scene;
      }
      if (!hit.valid() || hit.primitive != 0)
        continue;
      ++left;
      const Surface surface = surface_at(geometry, {}, ray, hit);
      const Ray next = ray_from(surface, away, std::numeric_limits<double>::infinity());
      const Hit again = closest(*accelerator, next);
      ASSERT_FALSE(again.valid()) << scene << ": " << again.primitive << " at " << again.t << " of " << size_here;
      // A shadow ray to a point above is unoccluded, too.
      Ray shadow = next;
      shadow.d *= size_here * std::pow(10.0, random.uniform(-3.0, 3.0));
      shadow.tmax = 1.0;
      ASSERT_FALSE(occluded(*accelerator, shadow)) << scene;
    }
  }
  EXPECT_GT(asked, 50000u);
  EXPECT_GT(left, asked / 2);
  EXPECT_GT(broad_ones, 500u);
}

} // namespace
} // namespace lancer::test
