// Objects of scenes: refusals, and trees that are made before a commit.
#include "accel/bvh/bvh_build.h"
#include "accel/mesh_bounds.h"
#include "compile/prepare.h"
#include "scene/fill.h"
#include "scene_pool.h"

#include <chrono>
#include <cstring>
#include <thread>

namespace lancer_test {
namespace {

TEST(SceneObjects, RefuseWhatIsNotThere) {
  Random random(5);
  const Pool pool(random);
  Listed listed = some(random);
  lancer_scene scene = edited(pool, listed, 0), other = 0;
  EXPECT_EQ(lancer_scene_edit(scene, &other), LANCER_ERROR_STATE);
  EXPECT_EQ(lancer_scene_edit(scene, nullptr), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(lancer_scene_edit(12345, &other), LANCER_ERROR_HANDLE);
  const lancer_object unknown[] = {777};
  EXPECT_EQ(lancer_scene_set_objects(scene, LANCER_OBJECT_MESH, 1, unknown), LANCER_ERROR_HANDLE);
  EXPECT_EQ(lancer_scene_set_objects(scene, LANCER_OBJECT_MESH, 1, pool.image_objects), LANCER_ERROR_ARGUMENT);
  EXPECT_STREQ(lancer_last_error(), "scene: object 0 is no mesh");
  EXPECT_EQ(lancer_scene_set_objects(scene, 9, 0, nullptr), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(lancer_scene_set_objects(scene, LANCER_OBJECT_MESH, 1, nullptr), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(lancer_scene_set_objects(scene, LANCER_OBJECT_WORLD, 2, pool.world_objects), LANCER_ERROR_ARGUMENT);
  lancer_object object = 0;
  EXPECT_EQ(lancer_object_create_material(&pool.materials[2], 0, 0, nullptr, &object), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(lancer_object_create_material(&pool.materials[2], 0, 1, pool.mesh_objects, &object), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(lancer_object_create_mesh(nullptr, 0, &object), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(lancer_object_destroy(777), LANCER_ERROR_HANDLE);
  EXPECT_EQ(lancer_object_prepare(777, 0), LANCER_ERROR_HANDLE);
  EXPECT_EQ(lancer_object_prepare(pool.mesh_objects[2], 1025), LANCER_ERROR_ARGUMENT);
  EXPECT_STREQ(lancer_last_error(), "object: threads 1025 > 1024");
  // Instances that refer to removed meshes and materials are refused by the commit, which can be mended.
  listed.instances[0].kind = LANCER_MESH;
  listed.instances[0].mesh = 2;
  lancer_scene_clear_instances(scene);
  add_instances(scene, listed);
  EXPECT_EQ(lancer_scene_set_objects(scene, LANCER_OBJECT_MESH, 2, pool.mesh_objects), LANCER_OK);
  EXPECT_EQ(lancer_scene_commit(scene, LANCER_BVH, 1), LANCER_ERROR_ARGUMENT);
  EXPECT_STREQ(lancer_last_error(), "instance #0: mesh 2 >= 2 meshes");
  EXPECT_EQ(lancer_scene_set_objects(scene, LANCER_OBJECT_MESH, 3, pool.mesh_objects), LANCER_OK);
  EXPECT_EQ(lancer_scene_set_objects(scene, LANCER_OBJECT_MATERIAL, 1, pool.material_objects), LANCER_OK);
  EXPECT_EQ(lancer_scene_commit(scene, LANCER_BVH, 1), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(lancer_scene_set_objects(scene, LANCER_OBJECT_MATERIAL, 3, pool.material_objects), LANCER_OK);
  commit(scene, LANCER_BVH, 1);
  // A committed scene does not change.
  EXPECT_EQ(lancer_scene_set_objects(scene, LANCER_OBJECT_MESH, 3, pool.mesh_objects), LANCER_ERROR_STATE);
  EXPECT_EQ(lancer_scene_clear_instances(scene), LANCER_ERROR_STATE);
  lancer_scene_destroy(scene);
}

TEST(SceneObjects, TreesMadeBeforeTheCommitHaveItsBits) {
  const Ball ball(16, 12);
  const lancer_mesh record = ball.mesh(true);
  lancer::Messages messages;
  const auto mesh = std::make_shared<const lancer::Mesh>(lancer::read_mesh(record, 0, messages));
  // A mesh that is gone when its turn comes is left out.
  lancer::prepare(std::make_shared<const lancer::Mesh>(*mesh), 1);
  lancer::prepare(mesh, 2);
  while (!mesh->tree.known())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::shared_ptr<const lancer::MeshBvh> early = mesh->tree.known();
  const lancer::PlacementFrame frame = lancer::mesh_frame(lancer::bounds_of(*mesh, mesh.get())->faces);
  const lancer::MeshBvh late = lancer::build_mesh_bvh(*mesh, frame, {});
  const auto equal = [](const auto &one, const auto &other) {
    return one.size() == other.size() && std::memcmp(one.data(), other.data(), one.size() * sizeof one[0]) == 0;
  };
  EXPECT_GT(early->nodes.size(), 1u);
  EXPECT_TRUE(equal(early->nodes, late.nodes));
  EXPECT_TRUE(equal(early->blocks, late.blocks));
}

TEST(SceneObjects, ScenesMayComeWhileTreesAreMade) {
  Random random(11);
  const Pool pool(random);
  Listed listed = some(random);
  listed.meshes = {2, 5, 2};
  for (const lancer_object object : pool.mesh_objects)
    ASSERT_EQ(lancer_object_prepare(object, 2), LANCER_OK);
  const lancer_scene scene = edited(pool, listed, 0), anew = made_anew(pool, listed);
  commit(scene, LANCER_BVH, 2);
  commit(anew, LANCER_BVH, 1);
  expect_equal(show(scene), show(anew));
  lancer_scene_destroy(scene);
  lancer_scene_destroy(anew);
}

} // namespace
} // namespace lancer_test
