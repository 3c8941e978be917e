// A ray crosses a closed surface exactly once per crossing: as often inwards as outwards, also at corners and edges.
#include "accel_scenes.h"

#include "scene/surface.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace lancer::test {
namespace {

// Returns the usual number of rays times LANCER_TEST_RAYS.
size_t ray_count(size_t usual) {
  const char *factor = std::getenv("LANCER_TEST_RAYS");
  return usual * (factor ? std::strtoull(factor, nullptr, 10) : 1);
}

// Flat sides of several triangles each, so that rays along them lie in planes of edges; corners have eight bits.
Mesh stairs() {
  Mesh mesh;
  constexpr uint32_t n = 6;
  std::vector<uint32_t> number((n + 1) * (n + 1) * (n + 1), kNone);
  const auto corner = [&](uint32_t x, uint32_t y, uint32_t z) {
    uint32_t &at = number[(z * (n + 1) + y) * (n + 1) + x];
    if (at == kNone) {
      at = static_cast<uint32_t>(mesh.positions.size());
      mesh.positions.push_back(glm::vec3(x, y, z) * 0.25f - 0.75f);
    }
    return at;
  };
  const auto filled = [](int x, int y, int z) {
    return x >= 0 && y >= 0 && z >= 0 && x < int(n) && y < int(n) && z < int(n) - std::max(x, y);
  };
  for (int x = 0; x < int(n); ++x)
    for (int y = 0; y < int(n); ++y)
      for (int z = 0; z < int(n); ++z)
        for (int side = 0; filled(x, y, z) && side < 6; ++side) {
          const int axis = side / 2, up = side & 1;
          glm::ivec3 next(x, y, z);
          next[axis] += up ? 1 : -1;
          if (filled(next.x, next.y, next.z))
            continue;
          uint32_t quad[4];
          for (int k = 0; k < 4; ++k) {
            glm::ivec3 p(x, y, z);
            p[axis] += up;
            p[(axis + 1) % 3] += k == 1 || k == 2;
            p[(axis + 2) % 3] += k >= 2;
            quad[k] = corner(uint32_t(p.x), uint32_t(p.y), uint32_t(p.z));
          }
          if (!up)
            std::swap(quad[1], quad[3]);
          mesh.triangles.push_back({quad[0], quad[1], quad[2]});
          mesh.triangles.push_back({quad[0], quad[2], quad[3]});
        }
  return mesh;
}

// A needle with two tips, 1e7 times as long as thick, with corners on no grid.
Mesh needle() {
  Mesh mesh;
  constexpr uint32_t around = 12;
  const glm::dvec3 along = glm::normalize(glm::dvec3(0.3, 0.7, 0.5)), across = glm::normalize(glm::cross(along, {0, 0, 1}));
  for (uint32_t i = 0; i < around; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / around;
    mesh.positions.push_back(glm::vec3(1e-7 * (std::cos(angle) * across + std::sin(angle) * glm::cross(along, across))));
    mesh.triangles.push_back({i, (i + 1) % around, around});
    mesh.triangles.push_back({(i + 1) % around, i, around + 1});
  }
  mesh.positions.push_back(glm::vec3(along));
  mesh.positions.push_back(glm::vec3(-along));
  return mesh;
}

// A ray from outside through a corner, a point of an edge, or of a face; one in four is along an axis of the mesh.
Ray aimed(Random &random, const Mesh &mesh, const Affine &to_world) {
  const uint32_t triangle = random.below(static_cast<uint32_t>(mesh.triangles.size()));
  const glm::dvec3 a = mesh.vertex(triangle, 0), b = mesh.vertex(triangle, 1), c = mesh.vertex(triangle, 2);
  const uint32_t kind = random.below(5);
  const double s = kind == 3 ? 0.5 : random.uniform(0.0, 1.0);
  const glm::dvec3 aim = kind < 2 ? a : kind < 4 ? (1.0 - s) * a + s * b : (a + b + c) / 3.0;
  glm::dvec3 away(0.0);
  const double distance = std::exp2(random.uniform(2.0, 20.0));
  if (random.below(4) == 0)
    away[int(random.below(3))] = random.below(2) ? distance : -distance;
  else
    away = distance * random.direction();
  const glm::dvec3 o = to_world.point(aim + away);
  return make_ray(o, to_world.point(aim) - o);
}

struct Crossings final : HitFilter {
  const Geometry *geometry;
  const Ray *rays;
  std::vector<std::vector<Hit>> of; // by ray

  Crossings(const uint8_t *asked, const Geometry &scene, const std::vector<Ray> &batch)
      : HitFilter(asked), geometry(&scene), rays(batch.data()), of(batch.size()) {}
  bool counts(size_t ray, const Hit &hit) override {
    of[ray].push_back(hit);
    return false;
  }
  void sort(size_t ray) {
    std::vector<Hit> &hits = of[ray];
    std::sort(hits.begin(), hits.end(), [](const Hit &a, const Hit &b) { return closer(a.t, a.instance, a.primitive, b); });
    const auto same = [](const Hit &a, const Hit &b) { return a.primitive == b.primitive; };
    hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
  }
  // Returns entries minus exits.
  int balance(size_t ray) const {
    int sum = 0;
    for (const Hit &hit : of[ray]) {
      const Instance &instance = geometry->instances[hit.instance];
      const Mesh &mesh = geometry->meshes[instance.mesh];
      const glm::dvec3 v0(mesh.vertex(hit.primitive, 0)), v1(mesh.vertex(hit.primitive, 1)), v2(mesh.vertex(hit.primitive, 2));
      sum += glm::dot(glm::cross(v1 - v0, v2 - v0), instance.to_object.vector(rays[ray].d)) < 0.0 ? 1 : -1;
    }
    return sum;
  }
};

void expect_pairs(const Mesh &mesh, const glm::dmat3 &linear, const glm::dvec3 &place, uint64_t seed) {
  Geometry geometry;
  geometry.meshes.push_back(mesh);
  geometry.instances.push_back(placed(ShapeKind::Mesh, linear, place));
  const uint8_t all_asked[] = {1};
  for (const Contestant &c : all_accelerators(geometry)) {
    Random random(seed);
    size_t odd = 0, unbalanced = 0, met = 0, walked = 0;
    const size_t count = ray_count(c.name == "brute force" ? 100 : 10000);
    std::vector<Ray> rays(std::min<size_t>(count, 10000));
    std::vector<uint8_t> occluded(rays.size());
    std::vector<Hit> hits(rays.size());
    for (size_t first = 0; first < count; first += rays.size()) {
      for (Ray &ray : rays)
        ray = aimed(random, mesh, geometry.instances[0].to_world);
      Crossings crossings(all_asked, geometry, rays);
      c.accelerator->any_hit(rays, occluded, crossings);
      // Every crossing once, each entry with one exit.
      for (size_t i = 0; i < rays.size(); ++i) {
        crossings.sort(i);
        odd += crossings.of[i].size() & 1;
        unbalanced += crossings.balance(i) != 0;
        met += !crossings.of[i].empty();
      }
      // Step from hit to hit, as paths continue behind a surface: the same hits, except for those with equal t.
      std::vector<size_t> step(rays.size(), 0);
      for (bool more = true; more;) {
        more = false;
        c.accelerator->closest_hit(rays, hits);
        for (size_t i = 0; i < rays.size(); ++i) {
          if (!(rays[i].tmin < rays[i].tmax))
            continue;
          const std::vector<Hit> &expected = crossings.of[i];
          while (step[i] > 0 && step[i] < expected.size() && expected[step[i]].t == expected[step[i] - 1].t)
            ++step[i];
          ASSERT_EQ(hits[i].valid(), step[i] < expected.size()) << c.name;
          if (!hits[i].valid()) {
            rays[i].tmax = rays[i].tmin;
            continue;
          }
          ASSERT_TRUE(same_bits(hits[i], expected[step[i]])) << c.name;
          ++step[i];
          ++walked;
          rays[i].tmin = hits[i].t;
          rays[i].skip_instance = hits[i].instance;
          rays[i].skip_primitive = hits[i].primitive;
          more = true;
        }
      }
    }
    EXPECT_EQ(odd, 0u) << c.name;
    EXPECT_EQ(unbalanced, 0u) << c.name;
    // Targets are on the surface, and rays to its outline may miss: more than half of the rays along the stairs' axes are of
    // this kind.
    EXPECT_GT(met, count * 2 / 3) << c.name;
    EXPECT_GT(walked, met) << c.name;
  }
}

const glm::dmat3 kSheared(glm::dvec3(0.7, 0.2, -0.4), glm::dvec3(-0.3, 1.1, 0.1), glm::dvec3(0.5, 0.2, -0.9));
const glm::dmat3 kMirrored(glm::dvec3(-1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0));
const glm::dmat3 kFlattened(glm::dvec3(1e3, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1e-3));
const glm::dvec3 kFar(1483760.0, 12340.0, -2234230.0); // more than a million radii

TEST(Crossings, InPairs) {
  expect_pairs(stairs(), glm::dmat3(1.0), glm::dvec3(0.0), 41);
  expect_pairs(bumpy_sphere(1.0, 64, 32, 0.1), glm::dmat3(1.0), glm::dvec3(0.0), 42);
}
TEST(Crossings, TinyAndHuge) {
  expect_pairs(stairs(), glm::dmat3(1e-6), glm::dvec3(0.0), 43);
  expect_pairs(bumpy_sphere(1.0, 64, 32, 0.1), glm::dmat3(1e9), glm::dvec3(0.0), 44);
}
TEST(Crossings, AMillionRadiiAway) {
  expect_pairs(stairs(), glm::dmat3(1.0), kFar, 45);
  expect_pairs(bumpy_sphere(1.0, 64, 32, 0.1), kSheared, kFar, 46);
}
TEST(Crossings, Mirrored) { expect_pairs(stairs(), kMirrored, glm::dvec3(1.0, 2.0, 3.0), 47); }
TEST(Crossings, Sheared) { expect_pairs(bumpy_sphere(1.0, 64, 32, 0.1), kSheared, glm::dvec3(1.0, 2.0, 3.0), 48); }
TEST(Crossings, AMillionTimesAsWideAsHigh) {
  expect_pairs(stairs(), kFlattened, glm::dvec3(1.0, 2.0, 3.0), 49);
  expect_pairs(bumpy_sphere(1.0, 64, 32, 0.1), kFlattened, glm::dvec3(1.0, 2.0, 3.0), 50);
}
TEST(Crossings, Needles) {
  expect_pairs(needle(), glm::dmat3(1.0), glm::dvec3(0.0), 51);
  expect_pairs(needle(), kSheared, glm::dvec3(1.0, 2.0, 3.0), 52);
}

} // namespace
} // namespace lancer::test
