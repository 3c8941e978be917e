// The pass Vector's input: places of instances, vertices and cameras at the moments around the picture.
#include "nodes_lab.h"

#include "compile/scene.h"
#include "scene/fill.h"

#include <cmath>
#include <gtest/gtest.h>

namespace lancer_test {
namespace {

using namespace lancer;

const float kCorners[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const uint32_t kHalves[] = {0, 1, 2, 0, 2, 3};
// The square one unit to the side, and twice as large.
const float kMomentCorners[] = {1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0, 0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0};

lancer_mesh square() {
  lancer_mesh mesh = {};
  mesh.name = "square";
  mesh.positions = kCorners;
  mesh.triangles = kHalves;
  mesh.vertex_count = 4;
  mesh.triangle_count = 2;
  mesh.vector_positions = kMomentCorners;
  return mesh;
}

// Placements that slide along x, at two moments.
std::vector<double> slides(std::initializer_list<double> ways) {
  std::vector<double> rows;
  for (const double way : ways)
    rows.insert(rows.end(), {1, 0, 0, way, 0, 1, 0, 0, 0, 0, 1, 0});
  return rows;
}

// Two squares, of one black material or that of the caller.
Description squares(lancer_parameter displacement = constant(0.0f)) {
  Description description;
  lancer_material material = black();
  material.displacement = displacement;
  add_material(description, material);
  add_mesh(description, square());
  lancer_instance instances[2] = {};
  for (lancer_instance &instance : instances) {
    const std::vector<double> here = slides({0.0});
    std::copy(here.begin(), here.end(), instance.matrix);
    instance.slot_count = 1;
  }
  const uint32_t slot = 0;
  add_instances(description, 2, instances, 1, &slot, nullptr, 0);
  return description;
}

std::string refusal(const std::function<void()> &call) {
  try {
    call();
  } catch (const Error &error) {
    return error.what();
  }
  return "";
}

TEST(Vectors, RefuseWhatNamesNoInstance) {
  Description description = squares();
  const std::vector<double> ways = slides({1, 2, 3, 4});
  const uint32_t beyond[] = {0, 2}, twice[] = {1, 1}, both[] = {1, 0};
  EXPECT_EQ(refusal([&] { set_vectors(description, 2, beyond, ways.data()); }), "vectors: instance 2 >= 2 instances");
  EXPECT_EQ(refusal([&] { set_vectors(description, 2, twice, ways.data()); }), "vectors: instance 1 was given before");
  EXPECT_EQ(refusal([&] { set_vectors(description, 2, both, nullptr); }), "vectors: NULL for 2 instances");
  EXPECT_EQ(refusal([&] { set_vectors(description, 2, nullptr, ways.data()); }), "vectors: NULL for 2 instances");
  EXPECT_TRUE(description.vectors.empty());
  set_vectors(description, 0, nullptr, nullptr);
  set_vectors(description, 2, both, ways.data());
  // The last call counts.
  set_vectors(description, 1, both, ways.data());
  ASSERT_EQ(description.vectors.size(), 1u);
  EXPECT_EQ(description.vectors[0].instance, 1u);
}

TEST(Vectors, AreOfTheInstancesThatHaveThem) {
  Description description = squares();
  const std::vector<double> ways = slides({-1, 3});
  const uint32_t second = 1;
  set_vectors(description, 1, &second, ways.data());
  const auto scene = commit(description, AcceleratorKind::Bvh, {});
  EXPECT_EQ(scene->vectors.find(0), nullptr);
  const MomentPlaces *const places = scene->vectors.find(1);
  ASSERT_NE(places, nullptr);
  for (uint32_t moment = 0; moment < kMoments; ++moment) {
    const glm::dvec3 way = scene->normalisation.to_world((*places)[moment].point(glm::dvec3(0.0)));
    EXPECT_EQ(way, glm::dvec3(moment == 0 ? -1.0 : 3.0, 0.0, 0.0));
  }
  // Nothing moves for rays.
  EXPECT_EQ(scene->features & kFeatureMotion, 0u);
  EXPECT_FALSE(scene->geometry.moves(scene->geometry.instances[1]));
  EXPECT_EQ(commit(squares(), AcceleratorKind::Bvh, {})->vectors.find(1), nullptr);
}

// The mesh is displaced at the moments as in the picture, and flattened with it.
TEST(Vectors, VerticesAreDisplacedAndFlattened) {
  const auto scene = commit(squares(constant(0, 0, 2)), AcceleratorKind::Bvh, {});
  const std::span<const glm::vec3> positions = scene->geometry.meshes[0].vector_positions;
  ASSERT_EQ(positions.size(), 8u);
  for (size_t i = 0; i < 8; ++i)
    EXPECT_EQ(positions[i], glm::vec3(kMomentCorners[3 * i], kMomentCorners[3 * i + 1], 2.0f)) << i;

  Description flat = squares();
  std::vector<float> raised(kMomentCorners, kMomentCorners + 24);
  for (size_t i = 2; i < 24; i += 3)
    raised[i] = 5.0f;
  lancer_mesh mesh = square();
  mesh.vector_positions = raised.data();
  add_mesh(flat, mesh);
  lancer_instance instance = {};
  const double squashed[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
  std::copy(squashed, squashed + 12, instance.matrix);
  instance.mesh = 1;
  instance.slot_count = 1;
  const uint32_t slot = 0;
  add_instances(flat, 1, &instance, 1, &slot, nullptr, 0);
  const auto laid = commit(flat, AcceleratorKind::Bvh, {});
  const Instance &last = laid->geometry.instances.back();
  for (const glm::vec3 &p : laid->geometry.meshes[last.mesh].vector_positions)
    EXPECT_EQ(p.z, 0.0f);
}

TEST(Vectors, VerticesThatAreNotFiniteStandStill) {
  std::vector<float> moments(kMomentCorners, kMomentCorners + 24);
  moments[3] = std::nanf("");
  moments[13] = 1e30f;
  lancer_mesh mesh = square();
  mesh.vector_positions = moments.data();
  Messages messages;
  const Mesh read = read_mesh(mesh, 0, messages);
  EXPECT_EQ(read.vector_positions[1], read.positions[1]);
  EXPECT_EQ(read.vector_positions[4], read.positions[0]);
  EXPECT_EQ(read.vector_positions[2], glm::vec3(2, 1, 0));
  EXPECT_EQ(read.triangles.size(), 2u);
  EXPECT_NE(messages.text().find("2 vertices one frame before or after"), std::string::npos);
}

TEST(Vectors, CameraStandsWhereItIsNotTold) {
  lancer_camera camera = {};
  const std::vector<double> here = slides({4.0});
  std::copy(here.begin(), here.end(), camera.matrix);
  camera.width = camera.height = camera.region_width = camera.region_height = 2;
  camera.window[0] = camera.window[2] = -1.0;
  camera.window[1] = camera.window[3] = 1.0;
  camera.clip_end = 10.0;
  CameraMoments moments = read_camera_moments(camera);
  EXPECT_FALSE(moments.moves);
  for (const Camera &at : moments.cameras)
    EXPECT_EQ(at.to_world.translation.x, 4.0);
  const std::vector<double> there = slides({6.0});
  std::copy(there.begin(), there.end(), camera.matrix_after);
  EXPECT_EQ(refusal([&] { read_camera_moments(camera); }), "camera: its window is empty");
  std::copy(camera.window, camera.window + 4, camera.window_after);
  camera.window_after[1] = 3.0;
  moments = read_camera_moments(camera);
  EXPECT_TRUE(moments.moves);
  EXPECT_EQ(moments.cameras[0].to_world.translation.x, 4.0);
  EXPECT_EQ(moments.cameras[1].to_world.translation.x, 6.0);
  EXPECT_EQ(moments.cameras[0].right, 1.0);
  EXPECT_EQ(moments.cameras[1].right, 3.0);
  camera.matrix_before[0] = 2.0;
  EXPECT_NE(refusal([&] { read_camera_moments(camera); }), "");
}

} // namespace
} // namespace lancer_test
