// Parts of random scenes, for comparisons of two pictures of one scene.
#pragma once

#include "picture_lab.h"

#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace lancer_test {

// A ball of few faces with smooth normals: at its rim mirror directions are below the surface.
struct Ball {
  std::vector<float> positions, normals;
  std::vector<uint32_t> triangles;

  explicit Ball(uint32_t around = 8, uint32_t rows = 5) {
    for (uint32_t row = 0; row <= rows; ++row)
      for (uint32_t i = 0; i < around; ++i) {
        const double theta = std::numbers::pi * (row + 0.02) / (rows + 0.04), phi = 2.0 * std::numbers::pi * i / around;
        for (const double x : {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)})
          positions.push_back(float(x));
      }
    normals = positions;
    for (uint32_t row = 0; row < rows; ++row)
      for (uint32_t i = 0; i < around; ++i) {
        const uint32_t a = row * around + i, b = row * around + (i + 1) % around, c = a + around, d = b + around;
        triangles.insert(triangles.end(), {a, c, b, b, c, d});
      }
  }

  lancer_mesh mesh(bool smooth) const {
    lancer_mesh mesh = {};
    mesh.name = "ball";
    mesh.positions = positions.data();
    mesh.vertex_count = uint32_t(positions.size() / 3);
    mesh.triangles = triangles.data();
    mesh.triangle_count = uint32_t(triangles.size() / 3);
    mesh.normals = smooth ? normals.data() : nullptr;
    mesh.normal_domain = smooth ? LANCER_NORMALS_VERTEX : LANCER_NORMALS_NONE;
    return mesh;
  }
};

using Random = std::mt19937;

inline float number(Random &random, float low = 0.0f, float high = 1.0f) {
  return low + (high - low) * float(random() >> 8) * 0x1p-24f;
}
// Returns a number in 0 ... 1, often an end of the range.
inline float share(Random &random) {
  const uint32_t kind = random() % 3;
  return kind == 0 ? 0.0f : kind == 1 ? 1.0f : number(random);
}
inline lancer_parameter color(Random &random) { return constant(number(random), number(random), share(random)); }

// A floor and twelve balls over it: one in one_in has the second mesh, a few are exact.
template <class Material> void place_balls(Studio &studio, Random &random, uint32_t one_in, Material &&material) {
  studio.place(LANCER_PLANE, material(), moved(0, 0, -1));
  for (int i = 0; i < 12; ++i) {
    const uint32_t kind = random() % 4 ? LANCER_MESH : LANCER_SPHERE;
    lancer_instance &thing =
        studio.place(kind, material(), moved(2.2 * (i % 4) - 3.3, 2.2 * (i / 4) - 2.2, number(random, -0.5f, 0.5f)));
    thing.mesh = random() % one_in == 0;
  }
}

// Expects equal bits of picture(seed, passes) in lanes, used for the picture alone, and one by one; and that the picture is not
// empty: its mean exceeds `least`.
template <class Picture> void expect_the_same_one_by_one(uint32_t seeds, double least, Picture &&picture) {
  constexpr uint32_t alone = 1u << LANCER_PASS_COMBINED;
  for (uint32_t seed = 1; seed <= seeds; ++seed) {
    const std::vector<float> lanes = picture(seed, alone);
    EXPECT_EQ(lanes, picture(seed, alone | 1u << LANCER_PASS_UV)) << "seed " << seed;
    double sum = 0.0;
    for (size_t i = 0; i < lanes.size(); ++i)
      sum += i % 4 == 3 ? 0.0 : double(lanes[i]);
    EXPECT_GT(sum, double(lanes.size()) * least) << "seed " << seed;
  }
}

// All layers that kernels support, and some that they do not.
inline lancer_principled principled(Random &random) {
  lancer_principled p = {};
  p.rules = random() % 2 ? LANCER_RULES_BLENDER_4 : LANCER_RULES_BLENDER_45;
  p.distribution = random() % 2 ? LANCER_DISTRIBUTION_GGX : LANCER_DISTRIBUTION_MULTI_GGX;
  p.option = 1;
  p.base_color = color(random);
  p.metallic = constant(share(random));
  // Also smooth, and so nearly smooth that only the reflection counts as rough.
  p.roughness = constant(random() % 4 ? number(random, 0.02f, 1.0f) : random() % 2 ? 0.0f : 0.007f);
  // Also indices that do not bend light, or so little that rough glass transmits straight through, and indices below 1.
  const float indices[] = {1.0f, 1.00005f, 1.001f, 0.7f};
  p.ior = constant(random() % 2 ? number(random, 1.0f, 2.5f) : indices[random() % 4]);
  p.diffuse_roughness = constant(random() % 4 ? 0.0f : 0.5f);
  p.specular = constant(number(random));
  p.specular_tint = random() % 2 ? constant(1.0f) : color(random);
  p.transmission = constant(random() % 2 ? 0.0f : share(random));
  p.coat = constant(random() % 2 ? 0.0f : share(random));
  p.coat_roughness = constant(random() % 3 ? number(random, 0.0f, 0.5f) : 0.0f);
  p.coat_ior = constant(number(random, 1.0f, 2.0f));
  p.coat_tint = constant(1.0f);
  p.sheen = constant(random() % 8 ? 0.0f : 0.5f);
  p.sheen_roughness = constant(0.5f);
  p.sheen_tint = constant(1.0f);
  p.transmission_roughness = p.anisotropic = p.anisotropic_rotation = p.coat_normal = p.emission = constant(0.0f);
  p.film_thickness = p.thin_wall = p.wall_scattering = p.wall_forward = constant(0.0f);
  p.subsurface = p.subsurface_radius = p.subsurface_color = p.subsurface_ior = p.subsurface_anisotropy = constant(0.0f);
  p.film_ior = constant(1.33f);
  return p;
}

} // namespace lancer_test
