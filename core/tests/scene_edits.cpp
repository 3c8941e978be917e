// Scenes that come by edits: their pictures have the bits of scenes that are filled anew, whatever was added, removed, moved,
// replaced, or cancelled half-way, and whatever became of the scenes before.
#include "scene_pool.h"

namespace lancer_test {
namespace {

// Changes one thing.
void edit(Random &random, Listed &listed) {
  const auto any = [&](auto &list) -> auto & { return list[random() % list.size()]; };
  switch (random() % 10) {
  case 0:
  case 1:
    listed.instances.push_back(instance(random, listed));
    return;
  case 2:
    if (listed.instances.size() > 1)
      listed.instances.erase(listed.instances.begin() + ptrdiff_t(random() % listed.instances.size()));
    listed.infos.resize(std::min(listed.infos.size(), 5 * listed.instances.size()));
    return;
  case 3:
  case 4:
    any(listed.instances).matrix[random() % 3 * 4 + 3] += double(number(random, -1, 1)) * (random() % 4 ? 1.0 : 30.0);
    return;
  case 5:
    any(listed.materials) = random() % kMaterials;
    return;
  case 6:
    any(listed.meshes) = random() % kMeshes;
    return;
  case 7:
    if (random() % 2 || listed.lights.empty())
      listed.lights.push_back(random() % kLights);
    else
      listed.lights.pop_back();
    return;
  case 8:
    listed.world = random() % kWorlds;
    return;
  default:
    listed.infos.resize(5 * (random() % (listed.instances.size() + 1)));
    for (float &x : listed.infos)
      x = number(random);
  }
}

TEST(SceneEdits, HaveTheBitsOfScenesMadeAnew) {
  for (uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Pool pool(random);
    Listed listed = some(random);
    const uint32_t accelerator = seed % 4 == 0 ? uint32_t(LANCER_KDTREE) : uint32_t(LANCER_BVH);
    lancer_scene scene = edited(pool, listed, 0);
    commit(scene, accelerator, 1);
    for (int step = 0; step < 10; ++step) {
      SCOPED_TRACE("step " + std::to_string(step));
      for (uint32_t edits = 1 + random() % 3; edits > 0; --edits)
        edit(random, listed);
      const lancer_scene next = edited(pool, listed, scene);
      if (random() % 4 == 0) {
        // A commit that is cancelled, at whatever place, leaves the scene before as it was.
        ASSERT_EQ(lancer_scene_commit(next, accelerator, 2), LANCER_OK);
        lancer_scene_cancel(next);
        while (lancer_scene_wait(next, 50) == LANCER_RUNNING)
          ;
        lancer_scene_destroy(next);
        continue;
      }
      // The scene before may go at any time.
      const bool early = random() % 2;
      if (early)
        lancer_scene_destroy(scene);
      commit(next, accelerator, 1 + random() % 2);
      if (!early)
        lancer_scene_destroy(scene);
      scene = next;
      const lancer_scene anew = made_anew(pool, listed);
      commit(anew, accelerator, 1);
      expect_equal(show(scene), show(anew));
      lancer_scene_destroy(anew);
      if (HasFailure())
        return;
    }
    lancer_scene_destroy(scene);
  }
}

// The counts of a commit after one edit.
lancer_made made_by(const Pool &pool, const Listed &before, const Listed &after) {
  const lancer_scene scene = edited(pool, before, 0);
  commit(scene, LANCER_BVH, 1);
  const lancer_scene next = edited(pool, after, scene);
  commit(next, LANCER_BVH, 1);
  lancer_made made;
  EXPECT_EQ(lancer_probe_made(next, &made), LANCER_OK);
  lancer_scene_destroy(scene);
  lancer_scene_destroy(next);
  return made;
}

std::vector<uint32_t> counts(const lancer_made &made) {
  return {made.placements, made.changed_meshes, made.materials, made.emitters, made.skies, made.plane_searches};
}

TEST(SceneEdits, MakeOnlyWhatAnEditTouches) {
  Random random(3);
  const Pool pool(random);
  Listed listed;
  // Balls with a plain, a displacing and an emitting material, under a sky by nodes; one around all, so that the bounds stay.
  listed.meshes = {0, 1, 2, 5};
  listed.materials = {0, 6, 5};
  listed.world = 2;
  for (uint32_t i = 0; i < 4; ++i) {
    lancer_instance ball = {};
    to_rows(i == 3 ? glm::scale(glm::dmat4(1.0), glm::dvec3(50.0)) : moved(3.0 * i, 0, 0), ball.matrix);
    ball.kind = LANCER_MESH;
    ball.mesh = i;
    ball.first_slot = i % 3;
    ball.slot_count = 1;
    listed.instances.push_back(ball);
  }
  EXPECT_EQ(counts(made_by(pool, listed, listed)), (std::vector<uint32_t>{0, 0, 0, 0, 0, 0}));
  Listed after = listed;
  after.materials[0] = 1;
  EXPECT_EQ(counts(made_by(pool, listed, after)), (std::vector<uint32_t>{0, 0, 1, 0, 0, 0})) << "a material";
  after = listed;
  after.lights = {1};
  EXPECT_EQ(counts(made_by(pool, listed, after)), (std::vector<uint32_t>{0, 0, 0, 0, 0, 0})) << "a lamp";
  after = listed;
  after.world = 0;
  EXPECT_EQ(counts(made_by(pool, listed, after)), (std::vector<uint32_t>{0, 0, 0, 0, 0, 0})) << "the world";
  after = listed;
  after.instances[0].matrix[7] = 0.25;
  EXPECT_EQ(counts(made_by(pool, listed, after)), (std::vector<uint32_t>{1, 0, 0, 0, 0, 1})) << "an object";
  after = listed;
  after.meshes[0] = 3;
  EXPECT_EQ(counts(made_by(pool, listed, after)), (std::vector<uint32_t>{1, 0, 0, 0, 0, 1})) << "a mesh";
  after = listed;
  after.meshes[1] = 3;
  EXPECT_EQ(counts(made_by(pool, listed, after)), (std::vector<uint32_t>{1, 1, 0, 0, 0, 1})) << "a displaced mesh";
}

TEST(SceneEdits, FacesInOnePlaneFollowTheirMaterials) {
  Random random(7);
  const Pool pool(random);
  Listed listed;
  // Two floors at one place: the first is hit as long as light does not pass it.
  for (uint32_t i = 0; i < 2; ++i) {
    lancer_instance floor = {};
    to_rows(glm::dmat4(1.0), floor.matrix);
    floor.kind = LANCER_PLANE;
    floor.first_slot = i;
    floor.slot_count = 1;
    listed.instances.push_back(floor);
  }
  const lancer_scene scene = edited(pool, listed, 0);
  commit(scene, LANCER_BVH, 1);
  listed.materials[0] = 3;
  const lancer_scene next = edited(pool, listed, scene), anew = made_anew(pool, listed);
  commit(next, LANCER_BVH, 1);
  commit(anew, LANCER_BVH, 1);
  expect_equal(show(next), show(anew));
  for (const lancer_scene each : {scene, next, anew})
    lancer_scene_destroy(each);
}

} // namespace
} // namespace lancer_test
