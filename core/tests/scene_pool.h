// Records of scenes, their objects, scenes of them by edits of other scenes and filled anew, and the pictures of these.
#pragma once

#include "lancer_probes.h"
#include "random_scenes.h"

#include <gtest/gtest.h>

namespace lancer_test {

constexpr uint32_t kMeshes = 6, kMaterials = 8, kLights = 4, kWorlds = 3, kImages = 2;

// All records that scenes may have, and their objects.
class Pool {
public:
  explicit Pool(Random &random) {
    for (uint32_t i = 0; i < kImages; ++i)
      for (uint32_t k = 0; k < 16 * 16 * 4; ++k)
        texels_[i].push_back(uint8_t(random()));
    for (uint32_t i = 0; i < kImages; ++i) {
      images[i] = image_of(texels_[i], 16, 16);
      images[i].name = "image";
      images[i].mipmaps = i;
      EXPECT_EQ(lancer_object_create_image(&images[i], i, &image_objects[i]), LANCER_OK) << lancer_last_error();
    }
    make_meshes(random);
    make_materials(random);
    for (uint32_t i = 0; i < kLights; ++i) {
      lights[i] = point_light();
      to_rows(moved(number(random, -4, 4), number(random, -4, 4), 5.0), lights[i].matrix);
      lights[i].kind = i == 3 ? uint32_t(LANCER_SUN) : uint32_t(LANCER_POINT);
      EXPECT_EQ(lancer_object_create_light(&lights[i], i, 0, nullptr, &light_objects[i]), LANCER_OK) << lancer_last_error();
    }
    make_worlds(random);
  }
  ~Pool() {
    const auto destroy = [](const auto &objects) {
      for (const lancer_object object : objects)
        EXPECT_EQ(lancer_object_destroy(object), LANCER_OK);
    };
    destroy(image_objects);
    destroy(mesh_objects);
    destroy(material_objects);
    destroy(light_objects);
    destroy(world_objects);
  }
  Pool(const Pool &) = delete;
  Pool &operator=(const Pool &) = delete;

  lancer_image images[kImages];
  lancer_mesh meshes[kMeshes];
  lancer_material materials[kMaterials];
  lancer_light lights[kLights];
  lancer_world worlds[kWorlds];
  lancer_object image_objects[kImages], mesh_objects[kMeshes], material_objects[kMaterials], light_objects[kLights],
      world_objects[kWorlds];

private:
  void make_meshes(Random &random) {
    for (uint32_t i = 0; i < kMeshes; ++i) {
      // Every third has enough faces for a tree of its own.
      balls_[i] = i % 3 == 2 ? Ball(16, 12) : Ball();
      for (float &x : balls_[i].positions)
        x *= number(random, 0.8f, 1.2f);
      if (i == 4)
        balls_[i].positions[0] = NAN; // faces are left out
      meshes[i] = balls_[i].mesh(i % 2);
      uvs_[i].resize(6 * meshes[i].triangle_count);
      for (float &x : uvs_[i])
        x = number(random);
      meshes[i].uvs = uvs_[i].data();
      EXPECT_EQ(lancer_object_create_mesh(&meshes[i], i, &mesh_objects[i]), LANCER_OK) << lancer_last_error();
    }
  }

  // Principled ones: two that light does not pass, one transparent by an image, one that emits by an image, one that emits, two
  // that displace.
  void make_materials(Random &random) {
    picture_ = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV),
                flagged(node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, {result_of(0)}), LANCER_INTERPOLATE_LINEAR << 4),
                node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY, {result_of(1), constant(0.2f)})};
    picture_[1].image_count = 1;
    for (uint32_t i = 0; i < kMaterials; ++i) {
      principled_[i] = principled(random);
      lobes_[i] = lobe(LANCER_PRINCIPLED, 0.5f);
      lobes_[i].principled = &principled_[i];
      lancer_material &m = materials[i] = black();
      m.name = "material";
      m.lobes = &lobes_[i];
      m.lobe_count = 1;
      m.emission = i == 5 ? constant(1.0f, 2.0f, 3.0f) : constant(0.0f);
      if (i >= 2 && i != 5) {
        m.nodes = picture_.data();
        m.node_count = uint32_t(picture_.size());
      }
      if (i < 2)
        principled_[i].transmission = constant(0.0f);
      else if (i == 2)
        principled_[i].base_color = result_of(1);
      else if (i == 3)
        m.transmittance = result_of(1);
      else if (i == 4)
        m.emission = result_of(1);
      else if (i >= 6)
        m.displacement = result_of(2);
      EXPECT_EQ(lancer_object_create_material(&m, i, kImages, image_objects, &material_objects[i]), LANCER_OK)
          << lancer_last_error();
    }
  }

  void make_worlds(Random &random) {
    sky_ = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_GENERATED),
            flagged(node(LANCER_NODE_ENVIRONMENT, 0, {result_of(0)}), LANCER_INTERPOLATE_LINEAR << 4)};
    sky_[1].image_count = 1;
    for (uint32_t i = 0; i < kWorlds; ++i) {
      worlds[i] = {};
      worlds[i].map_resolution = 16;
      worlds[i].radiance = i < 2 ? color(random) : result_of(1);
      worlds[i].nodes = sky_.data();
      worlds[i].node_count = i < 2 ? 0 : 2;
      EXPECT_EQ(lancer_object_create_world(&worlds[i], kImages, image_objects, &world_objects[i]), LANCER_OK)
          << lancer_last_error();
    }
  }

  std::vector<uint8_t> texels_[kImages];
  Ball balls_[kMeshes];
  std::vector<float> uvs_[kMeshes];
  std::vector<lancer_node> picture_, sky_;
  lancer_principled principled_[kMaterials];
  lancer_lobe lobes_[kMaterials];
};

// A scene as numbers of the pool's records.
struct Listed {
  std::vector<uint32_t> meshes{0, 1, 2}, materials{0, 1, 2}, lights{0};
  uint32_t world = 0;
  std::vector<lancer_instance> instances;
  std::vector<float> infos;
};

inline lancer_instance instance(Random &random, const Listed &listed) {
  lancer_instance thing = {};
  to_rows(moved(number(random, -3, 3), number(random, -3, 3), number(random, -1, 2)), thing.matrix);
  const uint32_t kind = random() % 8;
  thing.kind = kind == 0 ? uint32_t(LANCER_SPHERE) : kind == 1 ? uint32_t(LANCER_PLANE) : uint32_t(LANCER_MESH);
  thing.mesh = random() % listed.meshes.size();
  thing.first_slot = random() % listed.materials.size();
  thing.slot_count = 1;
  thing.object_index = random() % 5;
  if (random() % 6 == 0)
    thing.matrix[10] = 0.0; // flat
  const uint32_t shadings[] = {LANCER_SHADING_AS_MESH, LANCER_SHADING_AS_MESH, LANCER_SHADING_FLAT, LANCER_SHADING_PHONG};
  thing.shading = shadings[random() % 4];
  return thing;
}

// A scene of a few things, at some place.
inline Listed some(Random &random) {
  Listed listed;
  for (int i = 0; i < 6; ++i)
    listed.instances.push_back(instance(random, listed));
  return listed;
}

inline std::vector<uint32_t> slots_of(const Listed &listed) {
  std::vector<uint32_t> slots;
  for (uint32_t i = 0; i < listed.materials.size(); ++i)
    slots.push_back(i);
  return slots;
}

inline void add_instances(lancer_scene scene, const Listed &listed) {
  const std::vector<uint32_t> slots = slots_of(listed);
  ASSERT_EQ(lancer_scene_add_instances(scene, uint32_t(listed.instances.size()), listed.instances.data(),
                                       uint32_t(slots.size()), slots.data(), nullptr, 0),
            LANCER_OK)
      << lancer_last_error();
  if (listed.infos.empty())
    return;
  ASSERT_EQ(lancer_scene_set_object_infos(scene, uint32_t(listed.infos.size() / 5), listed.infos.data()), LANCER_OK)
      << lancer_last_error();
}

inline lancer_scene made_anew(const Pool &pool, const Listed &listed) {
  lancer_scene scene = 0;
  lancer_scene_create(&scene);
  for (const lancer_image &image : pool.images)
    lancer_scene_add_image(scene, &image);
  for (const uint32_t i : listed.meshes)
    lancer_scene_add_mesh(scene, &pool.meshes[i]);
  for (const uint32_t i : listed.materials)
    lancer_scene_add_material(scene, &pool.materials[i]);
  for (const uint32_t i : listed.lights)
    lancer_scene_add_light(scene, &pool.lights[i]);
  lancer_scene_set_world(scene, &pool.worlds[listed.world]);
  add_instances(scene, listed);
  return scene;
}

// before: 0 for an empty scene.
inline lancer_scene edited(const Pool &pool, const Listed &listed, lancer_scene before) {
  lancer_scene scene = 0;
  EXPECT_EQ(before ? lancer_scene_edit(before, &scene) : lancer_scene_create(&scene), LANCER_OK) << lancer_last_error();
  const auto give = [&](uint32_t kind, const lancer_object *all, const std::vector<uint32_t> &numbers) {
    std::vector<lancer_object> objects;
    for (const uint32_t i : numbers)
      objects.push_back(all[i]);
    EXPECT_EQ(lancer_scene_set_objects(scene, kind, uint32_t(objects.size()), objects.data()), LANCER_OK)
        << lancer_last_error();
  };
  give(LANCER_OBJECT_IMAGE, pool.image_objects, {0, 1});
  give(LANCER_OBJECT_MESH, pool.mesh_objects, listed.meshes);
  give(LANCER_OBJECT_MATERIAL, pool.material_objects, listed.materials);
  give(LANCER_OBJECT_LIGHT, pool.light_objects, listed.lights);
  give(LANCER_OBJECT_WORLD, pool.world_objects, {listed.world});
  EXPECT_EQ(lancer_scene_clear_instances(scene), LANCER_OK);
  add_instances(scene, listed);
  return scene;
}

inline void commit(lancer_scene scene, uint32_t accelerator, uint32_t threads) {
  ASSERT_EQ(lancer_scene_commit(scene, accelerator, threads), LANCER_OK) << lancer_last_error();
  while (lancer_scene_wait(scene, 50) == LANCER_RUNNING)
    ;
  ASSERT_EQ(lancer_scene_wait(scene, 0), LANCER_OK) << lancer_last_error();
}

struct Shown {
  std::vector<float> picture, normals;
  std::string messages;
  lancer_statistics statistics = {};
};

inline Shown show(lancer_scene scene) {
  lancer_camera camera = make_camera(16, 12);
  lancer_settings settings = make_settings();
  settings.passes = 1u << LANCER_PASS_COMBINED | 1u << LANCER_PASS_NORMAL;
  settings.samples = 2;
  lancer_session session = 0;
  EXPECT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(lancer_session_render(session, 0, settings.samples), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(finish(session), LANCER_OK);
  Shown shown;
  shown.picture.resize(16 * 12 * 4);
  shown.normals.resize(16 * 12 * 3);
  lancer_session_read(session, LANCER_PASS_COMBINED, shown.picture.data(), shown.picture.size());
  lancer_session_read(session, LANCER_PASS_NORMAL, shown.normals.data(), shown.normals.size());
  lancer_session_statistics(session, &shown.statistics);
  char text[8192];
  lancer_scene_messages(scene, text, sizeof text, nullptr);
  shown.messages = text;
  lancer_session_destroy(session);
  return shown;
}

inline void expect_equal(const Shown &one, const Shown &other) {
  EXPECT_EQ(one.picture, other.picture);
  EXPECT_EQ(one.normals, other.normals);
  EXPECT_EQ(one.messages, other.messages);
  EXPECT_EQ(one.statistics.triangles, other.statistics.triangles);
  EXPECT_EQ(one.statistics.lights, other.statistics.lights);
  EXPECT_STREQ(one.statistics.features, other.statistics.features);
  EXPECT_EQ(one.statistics.geometry_bytes, other.statistics.geometry_bytes);
  EXPECT_EQ(one.statistics.accelerator_bytes, other.statistics.accelerator_bytes);
}

} // namespace lancer_test
