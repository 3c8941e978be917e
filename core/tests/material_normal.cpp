// The normal of a whole material, used by displacement as a bump: it replaces the shading normal.
#include "picture_lab.h"
#include "roundings.h"

#include <gtest/gtest.h>
#include <numbers>

namespace lancer_test {
namespace {

// The height's slope along x, y and z: the normal tilts the other way on the plane z = 0.
const glm::vec3 kSlope(0.4f, -0.3f, 0.7f);

glm::vec3 leaning(float side = 1.0f) { return glm::normalize(glm::vec3(-kSlope.x, -kSlope.y, side)); }

// Heights are differences of floats of order 2^-7 over a step of as much, a few roundings each.
constexpr float kRough = 4e-6f;

enum class Bump { None, Material, Lobe };

// A white plane under a sun, seen from one side, with an optional bump.
std::unique_ptr<Studio> plane(Bump bump, const glm::dvec3 &sun = {0, 0, 1}, double side = 1.0,
                              lancer_parameter lobe_normal = constant(0.0f), uint32_t flags = 0) {
  auto studio = std::make_unique<Studio>();
  const std::vector<lancer_node> nodes = {
      node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_POSITION),
      node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_DOT_PRODUCT, {result_of(0), constant(kSlope.x, kSlope.y, kSlope.z)}),
      node(LANCER_NODE_BUMP, 0, {constant(1.0f), constant(1.0f), result_of(1), constant(0.0f), constant(1.0f)})};
  lancer_lobe white = lobe(LANCER_LAMBERT, 1.0f);
  white.rules = LANCER_RULES_BLENDER_45;
  white.normal = bump == Bump::Lobe ? result_of(2) : lobe_normal;
  lancer_material material = black();
  material.flags = flags;
  if (bump == Bump::Material)
    material.normal = result_of(2);
  studio->place(LANCER_PLANE, studio->add({white}, material, nodes));
  studio->add(studio->sun(sun, std::numbers::pi_v<float>));
  // The bump evaluates a pixel aside.
  studio->look({0, 0, 4 * side}, {0, 0, 0}, 1, 0x1p-7);
  studio->render();
  return studio;
}

TEST(MaterialNormal, LeansAgainstTheSlope) {
  expect_near(plane(Bump::Material)->color(LANCER_PASS_NORMAL), leaning(), kRough);
  expect_near(plane(Bump::None)->color(LANCER_PASS_NORMAL), {0, 0, 1}, 0.0f);
  // From below it is on the viewer's side.
  expect_near(plane(Bump::Material, {0, 0, -1}, -1.0)->color(LANCER_PASS_NORMAL), leaning(-1.0f), kRough);
}

TEST(MaterialNormal, LightsByItsOwnCosine) {
  // As in Cycles, without the softened terminator of a socket's bump, and beyond the plane's own horizon.
  for (const glm::dvec3 &sun :
       {glm::dvec3(0, 0, 1), glm::dvec3(-0.9, 0, 0.3), glm::dvec3(0.9, 0, 0.3), glm::dvec3(-1, 0.2, -0.1)}) {
    const float cosine = std::max(0.0f, glm::dot(leaning(), glm::vec3(glm::normalize(sun))));
    expect_near(plane(Bump::Material, sun)->color(), glm::vec3(cosine), kRough);
  }
  EXPECT_LT(plane(Bump::Lobe, {-0.9, 0, 0.3})->color().x, 0.95f * plane(Bump::Material, {-0.9, 0, 0.3})->color().x);
  EXPECT_EQ(plane(Bump::Lobe, {-1, 0.2, -0.1})->color().x, 0.0f);
}

TEST(MaterialNormal, WithoutCorrectionALobesOwnLightsAsMuch) {
  const glm::dvec3 sun(-0.9, 0, 0.3);
  const auto plain = plane(Bump::Lobe, sun, 1.0, constant(0.0f), LANCER_MATERIAL_NO_BUMP_CORRECTION);
  expect_near(plain->color(), plane(Bump::Material, sun)->color(), kRough);
}

TEST(MaterialNormal, GivesWayToALobesOwn) {
  const glm::vec3 own(0.6f, 0.0f, 0.8f);
  expect_near(plane(Bump::Material, {0, 0, 1}, 1.0, constant(own.x, own.y, own.z))->color(LANCER_PASS_NORMAL), own);
}

// A triangle whose normals all tilt to +x, seen obliquely from the other side.
std::unique_ptr<Studio> aslant(lancer_lobe look) {
  auto studio = std::make_unique<Studio>();
  const float positions[] = {-2, -2, 0, 2, -2, 0, 0, 4, 0}, normals[] = {0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f};
  const uint32_t corners[] = {0, 1, 2};
  lancer_mesh mesh = {};
  mesh.name = "triangle";
  mesh.positions = positions;
  mesh.normals = normals;
  mesh.normal_domain = LANCER_NORMALS_VERTEX;
  mesh.triangles = corners;
  mesh.vertex_count = 3;
  mesh.triangle_count = 1;
  studio->add(mesh);
  look.rules = LANCER_RULES_BLENDER_45;
  studio->place(LANCER_MESH, studio->add({look}));
  studio->add(studio->sun({0.2, 0, 1}, std::numbers::pi_v<float>));
  studio->look({-4, 0, 1}, {0, 0, 0});
  studio->render();
  return studio;
}

// Normalised at the hit and again for the pass: seven roundings each, of the squared length, its root, and the quotients.
constexpr float kNormal = float_roundings(14);

// Wide lobes keep an interpolated normal that faces away from the viewer, as on a coarse mesh.
TEST(MaterialNormal, WideLobesKeepOneThatLooksAway) {
  const glm::vec3 n = aslant(lobe(LANCER_LAMBERT, 1.0f))->color(LANCER_PASS_NORMAL);
  EXPECT_NEAR(n.x, 0.6f, kNormal);
  EXPECT_NEAR(n.z, 0.8f, kNormal);
}

TEST(MaterialNormal, WhatReflectsIsNeverSeenFromBehind) {
  lancer_lobe gloss = lobe(LANCER_GLOSSY, 1.0f);
  const glm::vec3 wo = glm::normalize(glm::vec3(-4, 0, 1)), n = aslant(gloss)->color(LANCER_PASS_NORMAL);
  EXPECT_NEAR(glm::length(n), 1.0f, kNormal);
  EXPECT_GT(glm::dot(n, wo), 0.0f);
}

} // namespace
} // namespace lancer_test
