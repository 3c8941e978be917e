// Pixels with nothing but background are not traced: pictures equal those of tracing everything, to the bit.
#include "random_scenes.h"
#include "render/film.h"

#include <gtest/gtest.h>

namespace lancer_test {
namespace {

constexpr uint32_t kWidth = 120, kHeight = 88, kSamples = 8;

struct Rendered {
  std::vector<std::vector<float>> passes;
  lancer_error error = {};
  uint64_t camera_rays = 0;
};

class Covered : public testing::Test {
protected:
  Covered() {
    lancer_scene_create(&scene_);
    add_material(scene_, {lobe(LANCER_LAMBERT, 0.6f), lobe(LANCER_BECKMANN, 0.3f)});
    lancer_world sky = {};
    sky.radiance = parameter(0.1f, 0.2f, 0.3f);
    lancer_scene_set_world(scene_, &sky);
    const Ball ball;
    const lancer_mesh mesh = ball.mesh(true);
    lancer_scene_add_mesh(scene_, &mesh);
    settings.samples = kSamples;
    settings.max_bounces = 2;
  }
  ~Covered() override { lancer_scene_destroy(scene_); }

  lancer_instance &put(uint32_t kind, const glm::dmat4 &m) {
    lancer_instance instance = {};
    to_rows(m, instance.matrix);
    instance.kind = kind;
    instance.slot_count = 1;
    instances_.push_back(instance);
    return instances_.back();
  }
  void add(const lancer_light &light) { EXPECT_EQ(lancer_scene_add_light(scene_, &light), LANCER_OK) << lancer_last_error(); }
  void commit() {
    const uint32_t slot = 0;
    lancer_scene_add_instances(scene_, uint32_t(instances_.size()), instances_.data(), 1, &slot, nullptr, 0);
    ASSERT_EQ(lancer_scene_commit(scene_, LANCER_BVH, 1), LANCER_OK) << lancer_last_error();
    while (lancer_scene_wait(scene_, 50) == LANCER_RUNNING)
      ;
  }
  // Renders in ranges of a few samples.
  Rendered render(uint32_t features) {
    settings.features = features;
    lancer_session session = 0;
    EXPECT_EQ(lancer_session_create(scene_, &camera, &settings, &session), LANCER_OK) << lancer_last_error();
    Rendered rendered;
    for (const auto &[first, count] : {std::pair{0u, 3u}, {3u, kSamples - 3u}}) {
      EXPECT_EQ(lancer_session_render(session, first, count), LANCER_OK) << lancer_last_error();
      EXPECT_EQ(finish(session), LANCER_OK);
    }
    for (uint32_t pass = 0; pass < LANCER_PASS_COUNT; ++pass) {
      const size_t pixels = size_t(camera.region_width) * camera.region_height;
      std::vector<float> &image = rendered.passes.emplace_back(pixels * lancer::channels(lancer::Pass(pass)));
      EXPECT_EQ(lancer_session_read(session, pass, image.data(), image.size()), LANCER_OK) << lancer_last_error();
    }
    EXPECT_EQ(lancer_session_error(session, 0.95, &rendered.error), LANCER_OK);
    lancer_statistics statistics = {};
    lancer_session_statistics(session, &statistics);
    rendered.camera_rays = statistics.camera_rays;
    lancer_session_destroy(session);
    return rendered;
  }
  // Returns the share of the camera rays that were traced.
  double expect_the_same_traced_or_not() {
    const Rendered few = render(LANCER_FEATURES_SCENE), all = render(LANCER_FEATURES_ALL);
    EXPECT_EQ(few.passes, all.passes);
    EXPECT_EQ(few.error.error, all.error.error);
    EXPECT_EQ(all.camera_rays, uint64_t(camera.region_width) * camera.region_height * kSamples);
    return double(few.camera_rays) / double(all.camera_rays);
  }

  lancer_scene scene_ = 0;
  std::vector<lancer_instance> instances_;
  lancer_camera camera = make_camera(kWidth, kHeight);
  lancer_settings settings = make_settings();
};

TEST_F(Covered, TracesWhatABallMayShow) {
  put(LANCER_MESH, moved(0, 0, 1));
  commit();
  const double traced = expect_the_same_traced_or_not();
  // The ball has a radius of a fifth of the height: an eighth of the picture, and blocks around its rim.
  EXPECT_GT(traced, 0.1);
  EXPECT_LT(traced, 0.25);
}

TEST_F(Covered, TracesNothingWhereThereIsNothing) {
  put(LANCER_MESH, moved(0, -20, 1));
  commit();
  EXPECT_EQ(expect_the_same_traced_or_not(), 0.0);
}

TEST_F(Covered, TracesAllWhereEverythingMayBeCovered) {
  put(LANCER_PLANE, moved(0, 0, 0));
  commit();
  EXPECT_EQ(expect_the_same_traced_or_not(), 1.0);
}

// A floor of two triangles from behind the camera to far away ends at a horizon.
TEST_F(Covered, CutsWhatReachesBehindTheCamera) {
  const float positions[] = {-50, -50, 0, 50, -50, 0, 50, 50, 0, -50, 50, 0};
  const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
  lancer_mesh mesh = {};
  mesh.name = "floor";
  mesh.positions = positions;
  mesh.triangles = triangles;
  mesh.vertex_count = 4;
  mesh.triangle_count = 2;
  lancer_scene_add_mesh(scene_, &mesh);
  put(LANCER_MESH, moved(0, 0, 0)).mesh = 1;
  commit();
  const double traced = expect_the_same_traced_or_not();
  EXPECT_GT(traced, 0.45);
  EXPECT_LT(traced, 0.6);
}

TEST_F(Covered, TracesLampsThatTheCameraSees) {
  lancer_light lamp = point_light();
  place(lamp.matrix, 0.5, 0, 1.5);
  lamp.hidden_from = LANCER_RAY_CAMERA;
  add(lamp);
  lamp.hidden_from = 0;
  place(lamp.matrix, -0.5, 0, 0.5);
  add(lamp);
  commit();
  const double traced = expect_the_same_traced_or_not();
  EXPECT_GT(traced, 0.0);
  EXPECT_LT(traced, 0.1);
}

TEST_F(Covered, LetsObjectsBeHiddenFromTheCamera) {
  put(LANCER_MESH, moved(0, 0, 1)).hidden_from = LANCER_RAY_CAMERA;
  commit();
  EXPECT_EQ(expect_the_same_traced_or_not(), 0.0);
}

TEST_F(Covered, TracesASkyThatVaries) {
  put(LANCER_MESH, moved(0, 0, 1));
  lancer_node nodes[] = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_GENERATED)};
  lancer_world world = {};
  world.radiance = result_of(0);
  world.nodes = nodes;
  world.node_count = 1;
  world.map_resolution = 16;
  EXPECT_EQ(lancer_scene_set_world(scene_, &world), LANCER_OK) << lancer_last_error();
  commit();
  EXPECT_EQ(expect_the_same_traced_or_not(), 1.0);
}

// Meshes and exact shapes, stretched and rotated, some around the camera; lamps; cameras of both kinds with lenses, borders and
// filters; transparent films.
class CoveredByChance : public Covered, public testing::WithParamInterface<uint32_t> {};

TEST_P(CoveredByChance, ShowsTheSame) {
  Random random(GetParam());
  const auto between = [&](double low, double high) { return double(number(random, float(low), float(high))); };
  const uint32_t kinds[] = {LANCER_MESH, LANCER_MESH, LANCER_MESH, LANCER_SPHERE, LANCER_CYLINDER, LANCER_CONE};
  for (uint32_t i = 0; i < 4; ++i) {
    const glm::dmat4 stretched = glm::scale(glm::dmat4(1.0), {between(0.05, 0.6), between(0.05, 0.6), between(0.05, 2.0)});
    const glm::dmat4 m = moved(between(-2, 2), between(-7, 4), between(0, 2.5)) *
                         turned(between(0, 360), between(-1, 1), between(-1, 1), 1.0) * stretched;
    put(kinds[random() % 6], m);
  }
  lancer_light lamp = point_light();
  place(lamp.matrix, between(-1, 1), between(-3, 3), between(0.5, 2));
  lamp.hidden_from = random() % 2 ? LANCER_RAY_CAMERA : 0;
  add(lamp);
  commit();
  if (random() % 3 == 0) {
    camera.kind = LANCER_ORTHOGRAPHIC;
    for (double &side : camera.window)
      side *= 5.0;
  }
  camera.lens_radius = random() % 2 ? between(0.0, 0.2) : 0.0;
  camera.focal_distance = between(3.0, 9.0);
  camera.aperture_ratio = random() % 2 ? 1.0 : between(0.5, 2.0);
  camera.aperture_blades = random() % 8;
  camera.clip_start = random() % 2 ? 0.1 : 0.0;
  if (random() % 2) {
    camera.x = 13;
    camera.y = 6;
    camera.region_width = 70;
    camera.region_height = 51;
  }
  settings.filter_width = float(between(0.5, 6.0));
  settings.film_transparent = random() % 2;
  settings.refines = random() % 2;
  settings.split_lights = settings.split_paths = 1 + random() % 2;
  // If something fills the view, or crosses the camera's plane, no pixel is empty.
  EXPECT_GT(expect_the_same_traced_or_not(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CoveredByChance, testing::Range(1u, 41u));

} // namespace
} // namespace lancer_test
