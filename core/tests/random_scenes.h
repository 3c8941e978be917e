// What scenes made by chance are made of: two pictures of one must be equal.
#pragma once

#include "picture_lab.h"

#include <random>

namespace lancer_test {

// A ball of few faces with normals of a smooth one: at its rim mirrored directions fall below the surface.
struct Ball {
  std::vector<float> positions, normals;
  std::vector<uint32_t> triangles;

  Ball() {
    constexpr uint32_t around = 8, rows = 5;
    for (uint32_t row = 0; row <= rows; ++row)
      for (uint32_t i = 0; i < around; ++i) {
        const double theta = M_PI * (row + 0.02) / (rows + 0.04), phi = 2.0 * M_PI * i / around;
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
// Often an end of the range.
inline float share(Random &random) {
  const uint32_t kind = random() % 3;
  return kind == 0 ? 0.0f : kind == 1 ? 1.0f : number(random);
}
inline lancer_parameter color(Random &random) { return constant(number(random), number(random), share(random)); }

} // namespace lancer_test
