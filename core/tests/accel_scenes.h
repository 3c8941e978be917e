// Geometry for the accelerator tests, and all accelerators over it.
#pragma once

#include "accel/accelerator.h"
#include "forced_instruction_set.h"
#include "geometry_lab.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace lancer::test {

class Random {
public:
  explicit Random(uint64_t seed) : engine(seed) {}
  double uniform(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine() >> 11) * 0x1p-53); }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(engine() % n); }
  glm::dvec3 in_box(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v = in_box(1.0);
      if (glm::dot(v, v) > 1e-4 && glm::dot(v, v) < 1.0)
        return glm::normalize(v);
    }
  }

private:
  std::mt19937_64 engine;
};

inline Instance placed(ShapeKind kind, const glm::dmat3 &linear, const glm::dvec3 &translation, uint32_t mesh = 0) {
  Instance instance;
  instance.kind = kind;
  instance.mesh = mesh;
  instance.place({linear, translation});
  return instance;
}

// A closed surface r(direction) = radius * (1 + bump * waves); shared corners, so no holes.
inline Mesh bumpy_sphere(double radius, uint32_t around, uint32_t along, double bump) {
  Mesh mesh;
  const auto point = [&](double theta, double phi) {
    const double r = radius * (1.0 + bump * std::sin(9.0 * phi) * std::sin(7.0 * theta));
    return glm::vec3(r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi), r * std::cos(theta));
  };
  for (uint32_t j = 1; j < along; ++j)
    for (uint32_t i = 0; i < around; ++i)
      mesh.positions.push_back(point(std::numbers::pi * j / along, 2.0 * std::numbers::pi * i / around));
  const uint32_t north = static_cast<uint32_t>(mesh.positions.size()), south = north + 1;
  mesh.positions.push_back(point(0.0, 0.0));
  mesh.positions.push_back(point(std::numbers::pi, 0.0));
  for (uint32_t i = 0; i < around; ++i) {
    const uint32_t next = (i + 1) % around, last = (along - 2) * around;
    mesh.triangles.push_back({north, i, next});
    mesh.triangles.push_back({last + i, south, last + next});
    for (uint32_t j = 0; j + 2 < along; ++j) {
      const uint32_t a = j * around + i, b = j * around + next;
      mesh.triangles.push_back({a, a + around, b});
      mesh.triangles.push_back({b, a + around, b + around});
    }
  }
  return mesh;
}

// Unconnected triangles of mixed sizes.
inline Mesh triangle_soup(Random &random, uint32_t count, double half) {
  Mesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 middle = random.in_box(half);
    const double size = half * std::exp2(random.uniform(-8.0, 0.0));
    for (int corner = 0; corner < 3; ++corner)
      mesh.positions.push_back(glm::vec3(middle + random.in_box(size)));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// Meshes in the world's tree, instances, exact surfaces with and without a box, and a mesh hidden from some rays. around: faces
// around the finer mesh; soup: triangles of the coarse one; half: half the size of the cube that contains everything.
inline Geometry everything(Random &random, uint32_t around, uint32_t soup, double half) {
  Geometry geometry;
  geometry.meshes.push_back(bumpy_sphere(1.0, around, 3 * around / 4, 0.2));
  geometry.meshes.push_back(triangle_soup(random, soup, 1.0));
  geometry.meshes.push_back(bumpy_sphere(1.0, 9, 6, 0.2));
  const auto add = [&](ShapeKind kind, double scale, uint32_t mesh) {
    geometry.instances.push_back(placed(kind, glm::dmat3(scale), random.in_box(half), mesh));
  };
  for (int i = 0; i < 12; ++i) {
    add(ShapeKind::Mesh, 1.5, 0);
    add(ShapeKind::Sphere, 1.0, 0);
    add(ShapeKind::Cone, 0.7, 0);
    add(ShapeKind::Cylinder, 0.7, 0);
  }
  add(ShapeKind::Mesh, 6.0, 1);
  add(ShapeKind::Mesh, 3.0, 2);
  geometry.instances.back().hidden_from = 1;
  add(ShapeKind::Plane, 1.0, 0);
  add(ShapeKind::Plane, 2.0, 0);
  return geometry;
}

inline Ray make_ray(const glm::dvec3 &o, const glm::dvec3 &d) {
  Ray ray;
  ray.o = o;
  ray.d = d;
  return ray;
}

struct Contestant {
  std::string name;
  std::unique_ptr<Accelerator> accelerator;
};

inline std::unique_ptr<Accelerator> build_bvh_for(const char *instruction_set, const Geometry &geometry, uint32_t threads) {
  const ForcedInstructionSet asked(instruction_set);
  return build_accelerator(AcceleratorKind::Bvh, geometry, {threads, nullptr});
}

// The reference first.
inline std::vector<Contestant> all_accelerators(const Geometry &geometry) {
  std::vector<Contestant> all;
  all.push_back({"brute force", build_accelerator(AcceleratorKind::BruteForce, geometry, {})});
  all.push_back({"kd-tree", build_accelerator(AcceleratorKind::KdTree, geometry, {2, nullptr})});
  for (const char *instruction_set : {"sse4", "avx2", "avx512"})
    all.push_back({std::string("bvh ") + instruction_set, build_bvh_for(instruction_set, geometry, 2)});
  return all;
}

inline Hit closest(const Accelerator &accelerator, const Ray &ray) {
  Hit hit;
  accelerator.closest_hit({&ray, 1}, {&hit, 1});
  return hit;
}

inline bool occluded(const Accelerator &accelerator, const Ray &ray) {
  uint8_t result = 2;
  accelerator.any_hit({&ray, 1}, {&result, 1});
  return result == 1;
}

inline bool same_bits(const Hit &a, const Hit &b) {
  return std::memcmp(&a.t, &b.t, sizeof a.t) == 0 && std::memcmp(&a.u, &b.u, sizeof a.u) == 0 &&
         std::memcmp(&a.v, &b.v, sizeof a.v) == 0 && a.instance == b.instance && a.primitive == b.primitive;
}

} // namespace lancer::test
