// Coplanar surfaces of different meshes: a ray from any side hits one of them, and a ray that leaves it hits none of the
// others.
#include "accel/coplanar/coplanar_faces.h"
#include "accel_scenes.h"
#include "scene/surface.h"

#include <gtest/gtest.h>

namespace lancer::test {
namespace {

// Adds a rectangle of n x m squares at a height, with separate corners for each triangle, transformed by a map and rounded to
// floats.
void add_grid(Mesh &mesh, const Affine &place, const glm::dvec2 &low, const glm::dvec2 &high, uint32_t n, uint32_t m,
              uint16_t slot = 0) {
  const auto corner = [&](uint32_t i, uint32_t k) {
    return glm::vec3(place.point({low.x + (high.x - low.x) * i / n, low.y + (high.y - low.y) * k / m, 0.0}));
  };
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t k = 0; k < m; ++k) {
      const glm::vec3 p[6] = {corner(i, k),         corner(i + 1, k), corner(i + 1, k + 1),
                              corner(i + 1, k + 1), corner(i, k + 1), corner(i, k)};
      for (const glm::vec3 &point : p) {
        if (mesh.positions.size() % 3 == 0) {
          const uint32_t next = static_cast<uint32_t>(mesh.positions.size());
          mesh.triangles.push_back({next, next + 1, next + 2});
          mesh.material_slots.push_back(slot);
        }
        mesh.positions.push_back(point);
      }
    }
}

Mesh grid(const Affine &place, const glm::dvec2 &low, const glm::dvec2 &high, uint32_t n, uint32_t m) {
  Mesh mesh;
  add_grid(mesh, place, low, high, n, m);
  return mesh;
}

// Rounds a map to floats.
Affine rounded(const Affine &a) { return {glm::dmat3(glm::mat3(a.linear)), glm::dvec3(glm::vec3(a.translation))}; }

Affine turned(Random &random) {
  const glm::dvec3 x = random.direction();
  glm::dvec3 y = random.direction();
  const glm::dvec3 z = glm::normalize(glm::cross(x, y));
  y = glm::cross(z, x);
  return {{x, y, z}, random.in_box(2.0)};
}

Affine scaled(const Affine &a, double scale) { return {a.linear * scale, a.translation * scale}; }
Affine lifted(double height) { return {glm::dmat3(1.0), {0.0, 0.0, height}}; }

// Two surfaces that cover the square -0.9 ... 0.9 of a plane.
struct Scene {
  Geometry geometry;
  Affine place;                                // maps the plane z = 0
  std::vector<uint8_t> transparent_instances;  // by slot
  uint32_t first_instance = 0;                 // the surface that rays must hit: an instance,
  uint32_t first_triangle = 0, end = 1u << 31; // and a range of its triangles
  bool closed = false;                         // from below, rays hit other parts first
  std::string name;
};

void add(Geometry &geometry, const Affine &place, Mesh mesh) {
  Instance instance;
  instance.mesh = static_cast<uint32_t>(geometry.meshes.size());
  instance.place(place);
  instance.slot_count = 2;
  geometry.meshes.push_back(std::move(mesh));
  geometry.instances.push_back(instance);
}

void add(Geometry &geometry, const Affine &place, ShapeKind kind) {
  Instance instance;
  instance.kind = kind;
  instance.place(place);
  geometry.instances.push_back(instance);
}

// A box below z = 0: five sides and a top.
Mesh box() {
  Mesh mesh = grid({glm::dmat3(1.0), {0.0, 0.0, 1.0}}, glm::dvec2(-1.0), glm::dvec2(1.0), 1, 1);
  const glm::dmat3 turns[5] = {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                               {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                               {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
                               {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
                               {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
  for (const glm::dmat3 &turn : turns)
    add_grid(mesh, {turn, turn * glm::dvec3(0.0, 0.0, 1.0)}, glm::dvec2(-1.0), glm::dvec2(1.0), 1, 1);
  return mesh;
}

std::vector<Scene> scenes(Random &random, double scale) {
  std::vector<Scene> all;
  const auto begin = [&](const char *name) -> Scene & {
    Scene &scene = all.emplace_back();
    scene.name = name;
    scene.place = rounded(scaled(turned(random), scale));
    return scene;
  };
  const glm::dvec2 one(1.0);
  {
    Scene &s = begin("corners in the world: a grid, a square, a finer grid");
    for (const uint32_t n : {7, 1, 23})
      add(s.geometry, {}, grid(s.place, -one, one, n, n + 2));
  }
  {
    Scene &s = begin("fine grids, of which some faces are compared");
    for (const uint32_t n : {48, 39})
      add(s.geometry, {}, grid(s.place, -one, one, n, n + 2));
  }
  {
    Scene &s = begin("one mesh, its second material first");
    Mesh mesh;
    add_grid(mesh, s.place, -one, one, 9, 5, 1);
    s.first_triangle = static_cast<uint32_t>(mesh.triangles.size());
    add_grid(mesh, s.place, -one, one, 2, 3, 0);
    s.end = static_cast<uint32_t>(mesh.triangles.size());
    add_grid(mesh, s.place, -one, one, 3, 2, 1);
    add(s.geometry, {}, std::move(mesh));
  }
  {
    // The box first: it hides the square on it.
    Scene &s = begin("a square on the top of a box");
    s.closed = true;
    const Affine below = {s.place.linear, s.place.point({0.0, 0.0, -1.0})};
    add(s.geometry, rounded(below), box());
    add(s.geometry, s.place, grid({}, -one, one, 3, 3));
  }
  {
    Scene &s = begin("two transforms, stretched each its own way");
    const glm::dmat3 stretch(glm::dvec3(3.0, 0.0, 0.0), glm::dvec3(0.7, 0.2, 0.0), glm::dvec3(0.0, 0.0, 5.0));
    const glm::dmat3 turn(glm::dvec3(0.6, 0.8, 0.0), glm::dvec3(-0.8, 0.6, 0.0), glm::dvec3(0.0, 0.0, 1.0));
    add(s.geometry, rounded(s.place * Affine{stretch, glm::dvec3(0.0)}),
        grid({}, glm::dvec2(-4.0, -10.0), glm::dvec2(4.0, 10.0), 4, 9));
    add(s.geometry, rounded(s.place * Affine{turn * 100.0, {0.0, 0.0, 0.0}}),
        grid({}, glm::dvec2(-0.02), glm::dvec2(0.02), 8, 3));
  }
  {
    Scene &s = begin("an endless plane and a grid");
    add(s.geometry, s.place, ShapeKind::Plane);
    add(s.geometry, {}, grid(s.place, -one, one, 11, 6));
  }
  {
    Scene &s = begin("the disk of a cylinder, a cone's and a square");
    s.closed = true;
    const Affine wide = {glm::dmat3(glm::dvec3(2.0, 0, 0), glm::dvec3(0, 2.0, 0), glm::dvec3(0, 0, 0.5)), glm::dvec3(0.0)};
    const Affine flipped = {glm::dmat3(glm::dvec3(2.0, 0, 0), glm::dvec3(0, -2.0, 0), glm::dvec3(0, 0, -1.0)),
                            {0.0, 0.0, -1.0}};
    add(s.geometry, {}, grid(s.place, -one, one, 2, 2));
    add(s.geometry, rounded(s.place * lifted(-0.5) * wide), ShapeKind::Cylinder);
    add(s.geometry, rounded(s.place * flipped), ShapeKind::Cone);
  }
  {
    Scene &s = begin("glass, glass, then what lets no light through");
    for (uint32_t i = 0; i < 3; ++i) {
      add(s.geometry, {}, grid(s.place, -one, one, 3 + 4 * i, 5));
      s.geometry.instances.back().first_slot = 2 * i;
    }
    s.transparent_instances = {1, 1, 1, 1, 0, 0};
    s.first_instance = 2;
  }
  return all;
}

struct Rule {
  std::string name;
  std::shared_ptr<const Accelerator> accelerator;
};

std::vector<Rule> all_with_rule(const Scene &scene) {
  const PlaneRules rules{glm::dvec3(0.0), scene.transparent_instances};
  std::vector<Rule> all;
  const BuildContext context{2, nullptr};
  const auto build = [&](AcceleratorKind kind) {
    return order_coplanar_faces(build_accelerator(kind, scene.geometry, context), scene.geometry, rules, context);
  };
  all.push_back({"brute force", build(AcceleratorKind::BruteForce)});
  all.push_back({"kd-tree", build(AcceleratorKind::KdTree)});
  for (const char *instruction_set : {"sse4", "avx2", "avx512"}) {
    const ForcedInstructionSet asked(instruction_set);
    all.push_back({std::string("bvh ") + instruction_set, build(AcceleratorKind::Bvh)});
  }
  return all;
}

// Rays towards the middle of the covered square, from either side, down to 1.5e-5 radians, where floats still define a plane;
// some come in bundles.
std::vector<Ray> rays_at(Random &random, const Scene &scene, size_t count) {
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const glm::dvec3 aim(random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), 0.0);
    const double angle = random.uniform(0.0, 6.3),
                 height = std::exp2(random.uniform(-16.0, 0.0)) * (scene.closed || random.below(2) ? 1.0 : -1.0);
    const glm::dvec3 from(std::cos(angle), std::sin(angle), height);
    const glm::dvec3 eye = scene.place.point(aim + from * std::exp2(random.uniform(0.0, 5.0)));
    const size_t bundle = random.below(3) ? 1 : 16;
    for (size_t i = 0; i < bundle; ++i) {
      const glm::dvec3 beside(random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), 0.0);
      rays.push_back(make_ray(eye, scene.place.point(aim + beside) - eye));
    }
  }
  return rays;
}

class Coplanar : public testing::TestWithParam<double> {};

TEST_P(Coplanar, OneIsMetFromAllSides) {
  const double scale = GetParam();
  Random random(91);
  for (const Scene &scene : scenes(random, scale)) {
    const std::vector<Ray> rays = rays_at(random, scene, 1000);
    std::vector<Hit> oracle;
    for (const Rule &rule : all_with_rule(scene)) {
      std::vector<Hit> hits(rays.size());
      rule.accelerator->closest_hit(rays, hits);
      size_t first = 0;
      for (const Hit &hit : hits)
        first += hit.instance == scene.first_instance && hit.primitive >= scene.first_triangle && hit.primitive < scene.end;
      EXPECT_EQ(first, rays.size()) << scene.name << ", " << rule.name;
      if (oracle.empty())
        oracle = hits;
      for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(same_bits(hits[i], oracle[i])) << scene.name << ", " << rule.name;
    }
  }
}

// Rays that leave the plane, to a lamp or to infinity, hit no other face of it.
TEST_P(Coplanar, NothingStopsWhatLeaves) {
  const double scale = GetParam();
  Random random(92);
  for (const Scene &scene : scenes(random, scale)) {
    const std::vector<Ray> rays = rays_at(random, scene, 500);
    const std::vector<uint32_t> slots(2 * scene.geometry.instances.size(), 0);
    const glm::dvec3 up = glm::normalize(glm::cross(scene.place.linear[0], scene.place.linear[1]));
    for (const Rule &rule : all_with_rule(scene)) {
      std::vector<Hit> hits(rays.size());
      rule.accelerator->closest_hit(rays, hits);
      std::vector<Ray> on;
      for (size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].valid())
          continue;
        const Surface surface = surface_at(scene.geometry, slots, rays[i], hits[i]);
        glm::dvec3 d = random.direction();
        // Upwards, where no scene has anything else, some nearly along the plane.
        d -= glm::dot(d, up) * up;
        d = glm::normalize(d) + std::exp2(random.uniform(-18.0, 1.0)) * up;
        on.push_back(ray_from(surface, d * scale, std::numeric_limits<double>::infinity()));
      }
      std::vector<Hit> next(on.size());
      std::vector<uint8_t> occluded(on.size());
      rule.accelerator->closest_hit(on, next);
      rule.accelerator->any_hit(on, occluded);
      size_t stopped = 0, shadowed = 0;
      for (size_t i = 0; i < on.size(); ++i) {
        stopped += next[i].valid();
        shadowed += occluded[i];
      }
      EXPECT_EQ(stopped, 0u) << scene.name << ", " << rule.name << ", of " << on.size();
      EXPECT_EQ(shadowed, 0u) << scene.name << ", " << rule.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scales, Coplanar, testing::Values(1e-6, 1e-3, 1.0, 1e3, 1e6));

} // namespace
} // namespace lancer::test
