// Faces partly covered by others: the cover is found wherever it is, and searched for nowhere else.
#include "accel/coplanar/coplanar_faces.h"
#include "accel_scenes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace lancer::test {
namespace {

constexpr uint32_t kTiles = 12; // along each axis

// A triangle in the plane z = 0 of a tile of side 1 around the origin.
Mesh tile_mesh() {
  Mesh mesh;
  mesh.positions = {{-0.4f, -0.3f, 0.0f}, {0.4f, -0.2f, 0.0f}, {0.1f, 0.4f, 0.0f}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

Mesh square_mesh(float half) {
  Mesh mesh;
  mesh.positions = {{-half, -half, 0.0f}, {half, -half, 0.0f}, {half, half, 0.0f}, {-half, half, 0.0f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

struct Place {
  glm::dvec2 at;
  double inside; // of the nearest small triangle, by distance to its nearest side; negative outside
};

// Many small triangles, each rotated differently, on a large face: a square of two triangles or an infinite plane.
struct Tiles {
  Geometry geometry;
  Affine frame;
  std::vector<Affine> places; // in the frame
  uint32_t large;

  Tiles(Random &random, double scale, ShapeKind kind, bool large_first) {
    const glm::dvec3 x = random.direction(), z = glm::normalize(glm::cross(x, random.direction()));
    const glm::dmat3 turn = scale * glm::dmat3(x, glm::cross(z, x), z);
    frame = {glm::dmat3(glm::mat3(turn)), glm::dvec3(glm::vec3(scale * random.in_box(2.0)))};
    geometry.meshes = {tile_mesh(), square_mesh(0.5f * kTiles + 1.0f)};
    large = large_first ? 0 : kTiles * kTiles;
    if (large_first)
      add(frame, 1, kind);
    for (uint32_t i = 0; i < kTiles * kTiles; ++i) {
      const double angle = random.uniform(0.0, 6.3), c = std::cos(angle), s = std::sin(angle);
      places.push_back({{{c, s, 0.0}, {-s, c, 0.0}, {0.0, 0.0, 1.0}},
                        {i % kTiles + 0.5 - 0.5 * kTiles, i / kTiles + 0.5 - 0.5 * kTiles, 0.0}});
      add(frame * places.back(), 0, ShapeKind::Mesh);
    }
    if (!large_first)
      add(frame, 1, kind);
  }

  void add(const Affine &place, uint32_t mesh, ShapeKind kind) {
    Instance instance;
    instance.kind = kind;
    instance.mesh = mesh;
    instance.slot_count = 2;
    instance.place({glm::dmat3(glm::mat3(place.linear)), glm::dvec3(glm::vec3(place.translation))});
    geometry.instances.push_back(instance);
  }

  // Returns a place anywhere near a small triangle, and every second time next to one of its sides.
  Place place(Random &random) const {
    const uint32_t tile = random.below(kTiles * kTiles);
    const Mesh &mesh = geometry.meshes[0];
    const glm::dvec3 corner[3] = {glm::dvec3(mesh.positions[0]), glm::dvec3(mesh.positions[1]), glm::dvec3(mesh.positions[2])};
    const uint32_t side = random.below(3);
    // In any rotation, within its tile.
    glm::dvec3 p(random.uniform(-0.35, 0.35), random.uniform(-0.35, 0.35), 0.0);
    if (random.below(2)) {
      const glm::dvec3 across(corner[(side + 1) % 3].y - corner[side].y, corner[side].x - corner[(side + 1) % 3].x, 0.0);
      p = glm::mix(corner[side], corner[(side + 1) % 3], random.uniform(0.1, 0.9)) +
          across * (std::exp2(random.uniform(-12.0, -4.0)) * (random.below(2) ? 1.0 : -1.0));
    }
    Place found{glm::dvec2(places[tile].point(p)), std::numeric_limits<double>::infinity()};
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 edge = corner[(i + 1) % 3] - corner[i];
      found.inside = std::min(found.inside, glm::cross(edge, p - corner[i]).z / glm::length(edge));
    }
    return found;
  }
};

// Placements are rounded to floats: 2^-23 of up to 16 tiles, in several terms.
constexpr double kRounding = 0x1p-16;
// 2^-20 of a face's size, which is below 128 tiles (an infinite plane's square is twice as wide as the scene), plus the
// rounding.
constexpr double kBorder = 0x1p-12;

class CoverTest : public testing::TestWithParam<double> {};

TEST_P(CoverTest, WhatLiesOnAFaceIsMetWhereItIs) {
  Random random(93);
  for (const ShapeKind kind : {ShapeKind::Mesh, ShapeKind::Plane})
    for (const bool large_first : {false, true}) {
      const Tiles tiles(random, GetParam(), kind, large_first);
      const BuildContext context{1, nullptr};
      const auto accelerator = order_coplanar_faces(build_accelerator(AcceleratorKind::Bvh, tiles.geometry, context),
                                                    tiles.geometry, PlaneRules{}, context);
      std::vector<Ray> rays;
      std::vector<Place> places;
      while (rays.size() < 20000) {
        const Place place = tiles.place(random);
        if (std::abs(place.inside) < kRounding)
          continue;
        const glm::dvec3 aim(place.at, 0.0),
            eye = aim + glm::dvec3(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), random.below(2) ? 5.0 : -5.0);
        rays.push_back(make_ray(tiles.frame.point(eye), tiles.frame.point(aim) - tiles.frame.point(eye)));
        places.push_back(place);
      }
      std::vector<Hit> hits(rays.size());
      accelerator->closest_hit(rays, hits);
      size_t wrong = 0;
      for (size_t i = 0; i < rays.size(); ++i)
        wrong += (hits[i].instance == tiles.large) != (large_first || places[i].inside < 0.0);
      EXPECT_EQ(wrong, 0u) << "kind " << int(kind) << ", large first " << large_first;
    }
}

TEST_P(CoverTest, NothingIsLookedForWhereNothingLies) {
  Random random(94);
  for (const ShapeKind kind : {ShapeKind::Mesh, ShapeKind::Plane}) {
    const Tiles tiles(random, GetParam(), kind, false);
    const FaceRounding rounding(tiles.geometry, glm::dvec3(0.0));
    const CoplanarFaces faces = find_coplanar_faces(tiles.geometry, rounding, {}, {1, nullptr});
    size_t missed = 0, in_vain = 0, outside = 0;
    for (int i = 0; i < 20000; ++i) {
      const Place place = tiles.place(random);
      const glm::dvec3 p = tiles.frame.point({place.at, 0.0});
      // The diagonal of the square separates its triangles.
      const uint32_t primitive = kind == ShapeKind::Mesh && place.at.y > place.at.x;
      const bool covered = faces.may_be_covered(tiles.large, primitive, p);
      EXPECT_EQ(covered, faces.may_lose(tiles.large, primitive, p));
      missed += place.inside >= 0.0 && !covered;
      outside += place.inside < -kBorder;
      in_vain += place.inside < -kBorder && covered;
    }
    EXPECT_GT(outside, 5000u);
    EXPECT_EQ(missed, 0u) << "kind " << int(kind);
    EXPECT_EQ(in_vain, 0u) << "kind " << int(kind);
  }
}

constexpr double kDisc = 0.1;

// A disc of triangles around (0, 0, 0), below many more triangles of about their size than are compared at first.
Mesh standing_mesh(Random &random, uint32_t sides, uint32_t others) {
  Mesh mesh;
  mesh.positions.push_back({0.0f, 0.0f, 0.0f});
  for (uint32_t i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    mesh.positions.push_back({float(kDisc * std::cos(angle)), float(kDisc * std::sin(angle)), 0.0f});
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % sides});
  }
  for (uint32_t i = 0; i < others; ++i) {
    const auto first = uint32_t(mesh.positions.size());
    const glm::dvec3 p = random.in_box(0.4) + glm::dvec3(0.0, 0.0, 1.0);
    for (int corner = 0; corner < 3; ++corner)
      mesh.positions.push_back(glm::vec3(p + random.in_box(0.01)));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST_P(CoverTest, LargeMeshesCoverTheFloorWhereTheyStand) {
  Random random(95);
  const double scale = GetParam();
  constexpr uint32_t kSides = 48;
  Geometry geometry;
  geometry.meshes = {square_mesh(8.0f), standing_mesh(random, kSides, 20000)};
  const auto add = [&](uint32_t mesh, double x) {
    Instance instance;
    instance.mesh = mesh;
    instance.slot_count = 1;
    instance.place({glm::dmat3(scale), {scale * x, 0.0, 0.0}});
    geometry.instances.push_back(instance);
  };
  for (const double x : {-2.0, 1.0, 3.0})
    add(1, x);
  add(0, 0.0);
  const FaceRounding rounding(geometry, glm::dvec3(0.0));
  const CoplanarFaces faces = find_coplanar_faces(geometry, rounding, {}, {1, nullptr});
  ASSERT_TRUE(faces.any());
  // Every side of each disc covers the floor, and nothing else does.
  size_t missed = 0, in_vain = 0;
  const double inner = kDisc * std::cos(std::numbers::pi / kSides);
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec2 at(random.uniform(-4.0, 4.0), random.uniform(-0.2, 0.2));
    double nearest = std::numeric_limits<double>::infinity();
    for (const double x : {-2.0, 1.0, 3.0})
      nearest = std::min(nearest, glm::length(at - glm::dvec2(x, 0.0)));
    const bool covered = faces.may_be_covered(3, at.y > at.x, {scale * at, 0.0});
    missed += nearest < inner - kBorder && !covered;
    in_vain += nearest > kDisc + kBorder && covered;
  }
  EXPECT_EQ(missed, 0u);
  EXPECT_EQ(in_vain, 0u);
  for (uint32_t primitive = 0; primitive < geometry.meshes[1].triangles.size(); ++primitive)
    EXPECT_EQ(faces.has(0, primitive), primitive < kSides);
}

INSTANTIATE_TEST_SUITE_P(Scales, CoverTest, testing::Values(1e-3, 1.0, 1e3));

} // namespace
} // namespace lancer::test
