// Origins of shadow rays on smooth meshes: the offset against closed forms, and its effect on a coarse ball.
#include "picture_lab.h"
#include "roundings.h"

#include "integrator/stages/terminator.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace lancer_test {
namespace {

constexpr float kLimit = 0.1f;

// A triangle with a unit normal at each corner.
struct Smooth {
  glm::vec3 v[3], n[3];
};

// Its mesh; vertices are stored in another order than the corners.
struct SmoothMesh {
  glm::vec3 positions[3], normals[3];
  uint32_t corners[3] = {2, 0, 1};
  lancer_mesh mesh = {};

  SmoothMesh(const Smooth &t, uint32_t domain) {
    for (int i = 0; i < 3; ++i) {
      positions[corners[i]] = t.v[i];
      normals[domain == LANCER_NORMALS_CORNER ? uint32_t(i) : corners[i]] = t.n[i];
    }
    mesh.name = "triangle";
    mesh.positions = &positions[0].x;
    mesh.normals = &normals[0].x;
    mesh.triangles = corners;
    mesh.vertex_count = 3;
    mesh.triangle_count = 1;
    mesh.normal_domain = domain;
  }
};

// A facet of a ball: corners on a circle of this radius, normals tilted outwards by the angle.
Smooth facet(double radius, double lean) {
  Smooth t;
  for (int i = 0; i < 3; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / 3.0, c = std::cos(turn), s = std::sin(turn);
    t.v[i] = glm::vec3(float(radius * c), float(radius * s), 0.0f);
    t.n[i] = glm::vec3(float(std::sin(lean) * c), float(std::sin(lean) * s), float(std::cos(lean)));
  }
  return t;
}

// Upright at the first corner, tilted away from it at the others.
Smooth leaning() {
  const float s = 0.6f, c = 0.8f;
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {s, 0, c}, {0, s, c}}};
}

const std::vector<double> kInPlace = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

struct Lifted {
  Stage stage;
  glm::dvec3 b; // weights of the corners

  explicit Lifted(const Smooth &t, const glm::dvec3 &weights, const std::vector<double> &rows = kInPlace,
                  uint32_t domain = LANCER_NORMALS_VERTEX)
      : stage(SmoothMesh(t, domain).mesh, rows), b(weights) {
    stage.description.instances[0].terminator = kLimit;
  }
  glm::dvec3 offset(const glm::vec3 &wi, const glm::vec3 &n = {0, 0, 1}, const glm::vec3 &ng = {0, 0, 1}) const {
    return terminator_offset(DescribedGeometry(stage.description), stage.surface(b.y, b.z), n, ng, wi);
  }
};

// Normals are rounded to float: parts in 10^7 of numbers below one.
void expect_offset(const glm::dvec3 &got, const glm::dvec3 &expected) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(got[i], expected[i], 2e-7) << "component " << i;
}

const glm::vec3 kGrazing(1.0f, 0.0f, 0.0f);

glm::dvec3 interpolated(const Smooth &t, const glm::dvec3 &b) {
  return b.x * glm::dvec3(t.n[0]) + b.y * glm::dvec3(t.n[1]) + b.z * glm::dvec3(t.n[2]);
}

TEST(Terminator, LiftsToTheLowestTangentPlane) {
  // From corner i of the facet the tangent plane rises to sin(lean) 3/2 radius (1 - b_i) above the point, along its normal.
  const double radius = 2.0, lean = 0.4;
  const Smooth t = facet(radius, lean);
  for (const glm::dvec3 &b : {glm::dvec3(1.0, 1.0, 1.0) / 3.0, glm::dvec3(0.5, 0.3, 0.2), glm::dvec3(0.1, 0.2, 0.7)}) {
    const double nearest = std::max({b.x, b.y, b.z});
    expect_offset(Lifted(t, b).offset(kGrazing), 1.5 * radius * std::sin(lean) * (1.0 - nearest) * interpolated(t, b));
  }
}

TEST(Terminator, LiftsToTheParaboloidWhereThatIsHigher) {
  // The upright corner's plane is the triangle's own: half of the sum b_i b_j (n_j - n_i).(v_j - v_i) over the edges remains.
  const Smooth t = leaning();
  const glm::dvec3 b(0.5, 0.3, 0.2);
  double height = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = i + 1; j < 3; ++j)
      height += 0.5 * b[i] * b[j] * glm::dot(glm::dvec3(t.n[j]) - glm::dvec3(t.n[i]), glm::dvec3(t.v[j]) - glm::dvec3(t.v[i]));
  // 0.5 (0.15 * 0.6 + 0.1 * 0.6 + 0.06 * 1.2), with 0.6 rounded to float.
  EXPECT_NEAR(height, 0.111, float_roundings(1, 0.111));
  expect_offset(Lifted(t, b).offset(kGrazing), height * interpolated(t, b));
}

TEST(Terminator, SinksTowardsLightBehind) {
  // Seen from inside the ball, the planes are 3/2 radius sin(lean) b_i behind.
  const double radius = 2.0, lean = 0.4;
  const Smooth t = facet(radius, lean);
  const glm::dvec3 b(0.5, 0.3, 0.2), expected = -1.5 * radius * std::sin(lean) * 0.2 * interpolated(t, b);
  // Light on the other side, and the same side seen from behind.
  const glm::vec3 below(1.0f, 0.0f, -0x1p-20f), above(1.0f, 0.0f, 0x1p-20f);
  expect_offset(Lifted(t, b).offset(below), expected);
  expect_offset(Lifted(t, b).offset(below, {0, 0, -1}, {0, 0, -1}), expected);
  const glm::dvec3 outside = 1.5 * radius * std::sin(lean) * 0.5 * interpolated(t, b);
  expect_offset(Lifted(t, b).offset(above), outside);
  expect_offset(Lifted(t, b).offset(above, {0, 0, -1}, {0, 0, -1}), outside);
}

TEST(Terminator, FadesInTowardsGrazing) {
  const Smooth t = facet(1.0, 0.4);
  const Lifted lifted(t, glm::dvec3(1.0, 1.0, 1.0) / 3.0);
  const glm::dvec3 whole = lifted.offset(kGrazing);
  const auto share = [&](float cos_n, float cos_g) {
    // The shading normal is upright; light and geometric normal are in the plane of x and z.
    const float light = std::acos(cos_n), tilt = light - std::acos(cos_g);
    const glm::vec3 wi(std::sin(light), 0.0f, std::cos(light)), ng(std::sin(tilt), 0.0f, std::cos(tilt));
    return glm::length(lifted.offset(wi, {0, 0, 1}, ng)) / glm::length(whole);
  };
  // Both cosines below the limit of 0.1: 2 minus their sum over the limit; otherwise 1 minus the geometric cosine over the
  // limit.
  EXPECT_EQ(share(0.5f, 0.5f), 0.0);
  EXPECT_EQ(share(0.11f, 0.1f), 0.0);
  // Each cosine is computed from an angle of up to 2, its sine and cosine and a product: 7 roundings, and 10 times as many over
  // 0.1.
  constexpr double rounding = float_roundings(2 * 7 * 10);
  EXPECT_NEAR(share(0.075f, 0.075f), 0.5, rounding);
  EXPECT_NEAR(share(0.09f, 0.02f), 0.9, rounding);
  EXPECT_NEAR(share(0.02f, 0.02f), 1.0, rounding);
  EXPECT_NEAR(share(0.5f, 0.025f), 0.75, rounding);
  EXPECT_NEAR(share(0.5f, -0.3f), 1.0, rounding);
}

TEST(Terminator, StandsAsTheInstanceStands) {
  // Heights are in the mesh's space; their direction is the instance's.
  const Smooth t = facet(1.0, 0.4);
  const glm::dvec3 b(0.5, 0.3, 0.2), offset = Lifted(t, b).offset(kGrazing);
  const glm::dvec3 placed = Lifted(t, b, {0, -3, 0, 7, 2, 0, 0, 8, 0, 0, 5, 9}).offset(kGrazing);
  expect_offset(placed, {-3.0 * offset.y, 2.0 * offset.x, 5.0 * offset.z});
  expect_offset(Lifted(t, b, kInPlace, LANCER_NORMALS_CORNER).offset(kGrazing), offset);
}

TEST(Terminator, IsNoneWhereTheSurfaceIsNotSmooth) {
  const Smooth t = facet(1.0, 0.4);
  const glm::dvec3 b(0.5, 0.3, 0.2), none(0.0);
  Lifted lifted(t, b);
  Instance &instance = lifted.stage.description.instances[0];
  EXPECT_NE(lifted.offset(kGrazing), none);
  instance.terminator = 0.0f;
  EXPECT_EQ(lifted.offset(kGrazing), none);
  instance.terminator = kLimit;
  instance.shading = Shading::Flat;
  EXPECT_EQ(lifted.offset(kGrazing), none);
  instance.shading = Shading::AsMesh;
  instance.kind = ShapeKind::Sphere;
  EXPECT_EQ(lifted.offset(kGrazing), none);
  // One normal at all corners, as of a flat face among smooth ones.
  Smooth flat = t;
  flat.n[0] = flat.n[1] = flat.n[2] = {0.6f, 0.0f, 0.8f};
  EXPECT_EQ(Lifted(flat, b, kInPlace, LANCER_NORMALS_CORNER).offset(kGrazing), none);
  EXPECT_EQ(Lifted(t, b, kInPlace, LANCER_NORMALS_NONE).offset(kGrazing), none);
}

constexpr int kRings = 6, kSegments = 12;

// A ball of few faces with the normals of a sphere.
struct CoarseBall {
  std::vector<float> positions;
  std::vector<uint32_t> triangles;

  CoarseBall() {
    for (int ring = 0; ring <= kRings; ++ring)
      for (int segment = 0; segment < kSegments; ++segment) {
        const double theta = std::numbers::pi * ring / kRings, phi = 2.0 * std::numbers::pi * (segment + 0.5) / kSegments;
        positions.insert(positions.end(), {float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)),
                                           float(std::cos(theta))});
      }
    for (uint32_t ring = 0; ring < kRings; ++ring)
      for (uint32_t segment = 0; segment < kSegments; ++segment) {
        const uint32_t next = (segment + 1) % kSegments, a = ring * kSegments + segment, b = ring * kSegments + next;
        triangles.insert(triangles.end(), {a, a + kSegments, b + kSegments, a, b + kSegments, b});
      }
  }
  lancer_mesh mesh() const {
    lancer_mesh m = {};
    m.name = "ball";
    m.positions = m.normals = positions.data();
    m.normal_domain = LANCER_NORMALS_VERTEX;
    m.triangles = triangles.data();
    m.vertex_count = uint32_t(positions.size() / 3);
    m.triangle_count = uint32_t(triangles.size() / 3);
    return m;
  }
};

const glm::dvec3 kSun(0.9, -0.3, 0.2);

// At 87 degrees to the faces towards the camera.
const glm::dvec3 kGrazingSun(1.0, -0.05, 0.0);

// The ball with the sun from the side.
std::unique_ptr<Studio> ball(float terminator, uint32_t kind = LANCER_MESH, uint32_t shading = LANCER_SHADING_AS_MESH,
                             bool with_bead = false) {
  auto studio = std::make_unique<Studio>();
  const CoarseBall shape;
  studio->add(shape.mesh());
  // By the newest rules: older ones adjust the normal if a reflection would hit the face.
  lancer_lobe white = lobe(LANCER_LAMBERT, 1.0f);
  white.rules = LANCER_RULES_BLENDER_45;
  lancer_instance &instance = studio->place(kind, studio->add({white}));
  instance.terminator = terminator;
  instance.shading = shading;
  // A bead beside the centre of the picture casts its shadow on faces at grazing angles to the sun.
  if (with_bead)
    studio->place(LANCER_SPHERE, studio->add({}, black()),
                  moved(0.45, -1.1, 0.0) * glm::scale(glm::dmat4(1.0), glm::dvec3(0.15)));
  studio->add(studio->sun(with_bead ? kGrazingSun : kSun, std::numbers::pi_v<float>));
  studio->look({0, -5, 0}, {0, 0, 0}, 128, 2.2);
  studio->render();
  return studio;
}

TEST(Terminator, ACoarseBallHasNoHardEdges) {
  // Counts pixels on the sun's side that are in shadow, and pixels whose brightness is not their cosine.
  const auto count = [](const Studio &studio) {
    const auto picture = studio.read(LANCER_PASS_COMBINED, 4), normals = studio.read(LANCER_PASS_NORMAL, 3);
    const glm::vec3 sun(glm::normalize(kSun));
    int shadowed = 0, others = 0;
    for (size_t i = 0; i < picture.size() / 4; ++i) {
      const glm::vec3 n(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
      const float cosine = glm::dot(n, sun), level = picture[4 * i];
      if (n == glm::vec3(0.0f) || cosine < 0.0f)
        continue;
      // A few roundings to float.
      if (level == 0.0f && cosine > 1e-6f)
        ++shadowed;
      else if (std::abs(level - cosine) > 1e-6f)
        ++others;
    }
    return std::pair(shadowed, others);
  };
  EXPECT_EQ(count(*ball(kLimit)), std::pair(0, 0));
  // Of some 6000 pixels on the sun's side, those on faces that face away from it.
  const auto [shadowed, others] = count(*ball(0.0f));
  EXPECT_GT(shadowed, 200);
  EXPECT_EQ(others, 0);
}

TEST(Terminator, ChangesNoOtherBall) {
  const auto picture = [](float terminator, uint32_t kind, uint32_t shading) {
    return ball(terminator, kind, shading, true)->read(LANCER_PASS_COMBINED, 4);
  };
  for (const auto &[kind, shading] : {std::pair(LANCER_MESH, LANCER_SHADING_FLAT), {LANCER_SPHERE, LANCER_SHADING_AS_MESH}})
    EXPECT_EQ(picture(kLimit, kind, shading), picture(0.0f, kind, shading));
  EXPECT_NE(picture(kLimit, LANCER_MESH, LANCER_SHADING_AS_MESH), picture(0.0f, LANCER_MESH, LANCER_SHADING_AS_MESH));
}

} // namespace
} // namespace lancer_test
