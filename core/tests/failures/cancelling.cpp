// Renders and builds cancelled at any moment: no thread and no memory is left, and the next one is unaffected.
#include "failing.h"
#include "whole_render.h"

#include "../tiny_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <random>
#include <thread>

namespace {

using namespace lancer_test;
using Clock = std::chrono::steady_clock;

// LANCER_CANCELS: number of repetitions; few by default.
int repeats() {
  const char *asked = std::getenv("LANCER_CANCELS");
  return asked ? std::atoi(asked) : 50;
}

size_t threads_now() {
  size_t count = 0;
  for ([[maybe_unused]] const auto &entry : std::filesystem::directory_iterator("/proc/self/task"))
    ++count;
  return count;
}

// A joined thread may be listed for a moment longer; a leaked thread is listed forever.
bool threads_come_down_to(size_t count) {
  for (int i = 0; i < 100000 && threads_now() > count; ++i)
    std::this_thread::yield();
  return threads_now() <= count;
}

// A pause of a random share of the work's duration, which depends on the machine's load: the longest pause becomes shorter if
// it ended too late, and longer if not.
class Moment {
public:
  explicit Moment(std::chrono::nanoseconds whole) : longest_(1.1 * double(whole.count())) {}
  void wait() {
    for (const auto end = Clock::now() + std::chrono::nanoseconds(int64_t(longest_ * share_(random_))); Clock::now() < end;)
      std::this_thread::yield();
  }
  void follow(bool in_time) { longest_ *= in_time ? 1.05 : 0.85; }

private:
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> share_;
  double longest_;
};

// Does a piece of work completely, then repeatedly interrupted at a moment; counts cancellations. The work receives the moment,
// if any, and the number of the repetition.
template <class Work> void break_off(int times, int &cancelled, const Work &work) {
  // Warm up, then time the whole.
  ASSERT_EQ(work(nullptr, 0), LANCER_OK) << lancer_last_error();
  const auto start = Clock::now();
  ASSERT_EQ(work(nullptr, 0), LANCER_OK) << lancer_last_error();
  Moment moment(Clock::now() - start);

  const size_t threads = threads_now();
  cancelled = 0;
  for (int i = 0; i < times; ++i) {
    SCOPED_TRACE(i);
    const int64_t memory = live_memory();
    const lancer_status status = work(&moment, i);
    ASSERT_TRUE(status == LANCER_OK || status == LANCER_CANCELLED) << status << ": " << lancer_last_error();
    cancelled += status == LANCER_CANCELLED;
    moment.follow(status == LANCER_CANCELLED);
    ASSERT_TRUE(threads_come_down_to(threads));
    ASSERT_EQ(live_memory(), memory);
  }
  ASSERT_EQ(work(nullptr, 0), LANCER_OK) << lancer_last_error();
}

lancer_status finish_scene(lancer_scene scene) {
  lancer_status status;
  while ((status = lancer_scene_wait(scene, 50)) == LANCER_RUNNING)
    ;
  return status;
}

// Renders 16 samples of 24 x 16 pixels; cancels after the moment, if given.
lancer_status render(lancer_scene scene, std::vector<float> &image, Moment *moment) {
  const lancer_camera camera = make_camera();
  const lancer_settings settings = make_settings();
  lancer_session session = 0;
  EXPECT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(lancer_session_render(session, 0, 16), LANCER_OK) << lancer_last_error();
  if (moment) {
    moment->wait();
    EXPECT_EQ(lancer_session_cancel(session), LANCER_OK);
  }
  const lancer_status status = finish(session);
  EXPECT_EQ(lancer_session_read(session, LANCER_PASS_COMBINED, image.data(), image.size()), LANCER_OK);
  lancer_statistics statistics;
  EXPECT_EQ(lancer_session_statistics(session, &statistics), LANCER_OK);
  EXPECT_EQ(statistics.invalid_samples, 0u);
  if (status == LANCER_CANCELLED) {
    EXPECT_EQ(lancer_session_render(session, 16, 1), LANCER_ERROR_STATE);
  }
  EXPECT_EQ(lancer_session_destroy(session), LANCER_OK);
  return status;
}

TEST(Cancelling, RendersLeaveNothingBehind) {
  const lancer_scene scene = make_scene();
  std::vector<float> whole(24 * 16 * 4), image(whole.size());
  ASSERT_EQ(render(scene, whole, nullptr), LANCER_OK);
  int cancelled = 0;
  ASSERT_NO_FATAL_FAILURE(break_off(repeats(), cancelled, [&](Moment *moment, int) {
    const lancer_status status = render(scene, image, moment);
    if (status == LANCER_OK) {
      EXPECT_EQ(image, whole);
    }
    EXPECT_TRUE(std::all_of(image.begin(), image.end(), [](float value) { return std::isfinite(value); }));
    return status;
  }));
  // Moments are spread over the whole render, whatever its duration.
  EXPECT_GT(cancelled, repeats() / 4);
  lancer_scene_destroy(scene);
}

// Doubles samples until nothing is left to double; cancels or stops after the moment, if given.
lancer_status refine(lancer_scene scene, std::vector<float> &image, Moment *moment, bool stops) {
  const lancer_camera camera = make_camera();
  lancer_settings settings = make_settings();
  settings.refines = 1;
  // So many that the rounds take longer than a thread needs to start on a busy machine.
  settings.samples = 128;
  lancer_session session = 0;
  EXPECT_EQ(lancer_session_create(scene, &camera, &settings, &session), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(lancer_session_render(session, 0, 2), LANCER_OK) << lancer_last_error();
  EXPECT_EQ(finish(session), LANCER_OK);
  const auto rounds = [&] {
    lancer_status status = LANCER_OK, started;
    while (status == LANCER_OK && (started = lancer_session_refine(session, 0.0, 0.95)) == LANCER_OK)
      status = finish(session);
    EXPECT_TRUE(status != LANCER_OK || started == LANCER_CANCELLED) << lancer_last_error();
    return status;
  };
  std::thread other;
  if (moment)
    other = std::thread([&] {
      moment->wait();
      EXPECT_EQ(stops ? lancer_session_stop(session) : lancer_session_cancel(session), LANCER_OK);
    });
  const lancer_status status = rounds();
  if (other.joinable())
    other.join();
  lancer_error error;
  EXPECT_EQ(lancer_session_error(session, 0.95, &error), LANCER_OK);
  EXPECT_TRUE(error.low <= error.error && error.error <= error.high) << error.low << " " << error.error << " " << error.high;
  EXPECT_EQ(lancer_session_read(session, LANCER_PASS_COMBINED, image.data(), image.size()), LANCER_OK);
  EXPECT_EQ(lancer_session_destroy(session), LANCER_OK);
  return status;
}

TEST(Cancelling, RefinementsLeaveNothingBehind) {
  const lancer_scene scene = make_scene();
  std::vector<float> whole(24 * 16 * 4), image(whole.size());
  ASSERT_EQ(refine(scene, whole, nullptr, false), LANCER_OK);
  int cancelled = 0;
  ASSERT_NO_FATAL_FAILURE(break_off(repeats(), cancelled, [&](Moment *moment, int time) {
    const bool stops = time % 2 != 0;
    const lancer_status status = refine(scene, image, moment, stops);
    // After a stop it has continued to the same end.
    EXPECT_TRUE(status == LANCER_OK || !stops);
    if (status == LANCER_OK) {
      EXPECT_EQ(image, whole);
    }
    return status;
  }));
  EXPECT_GT(cancelled, repeats() / 8);
  lancer_scene_destroy(scene);
}

// A wavy sheet with this many squares per side.
struct Sheet {
  std::vector<float> positions;
  std::vector<uint32_t> triangles;

  explicit Sheet(uint32_t side) {
    for (uint32_t y = 0; y <= side; ++y)
      for (uint32_t x = 0; x <= side; ++x)
        positions.insert(positions.end(), {float(x), float(y), std::sin(float(3 * x + 5 * y))});
    for (uint32_t y = 0; y < side; ++y)
      for (uint32_t x = 0; x < side; ++x) {
        const uint32_t a = y * (side + 1) + x, b = a + side + 1;
        triangles.insert(triangles.end(), {a, a + 1, b, a + 1, b + 1, b});
      }
  }
  lancer_mesh mesh() const {
    lancer_mesh mesh = {};
    mesh.name = "sheet";
    mesh.positions = positions.data();
    mesh.triangles = triangles.data();
    mesh.vertex_count = uint32_t(positions.size() / 3);
    mesh.triangle_count = uint32_t(triangles.size() / 3);
    return mesh;
  }
};

// An emitting mesh, so that a light tree is built as well; not yet committed.
lancer_scene open_scene(const Sheet &sheet) {
  lancer_scene scene = 0;
  EXPECT_EQ(lancer_scene_create(&scene), LANCER_OK);
  add_material(scene, {lobe(LANCER_LAMBERT, 0.5f)}, 1.0f);
  const lancer_mesh mesh = sheet.mesh();
  EXPECT_EQ(lancer_scene_add_mesh(scene, &mesh), LANCER_OK) << lancer_last_error();
  lancer_instance instance = {};
  place(instance.matrix, -2.0, -2.0, 0.0, 0.05);
  instance.slot_count = 1;
  const uint32_t slot = 0;
  EXPECT_EQ(lancer_scene_add_instances(scene, 1, &instance, 1, &slot, nullptr, 0), LANCER_OK);
  return scene;
}

class CancelledBuilds : public testing::TestWithParam<uint32_t> {};

TEST_P(CancelledBuilds, LeaveNothingBehind) {
  const Sheet sheet(60);
  int cancelled = 0;
  ASSERT_NO_FATAL_FAILURE(break_off(repeats() / 2, cancelled, [&](Moment *moment, int time) {
    const lancer_scene scene = open_scene(sheet);
    EXPECT_EQ(lancer_scene_commit(scene, GetParam(), 2), LANCER_OK);
    // Destroying the scene also cancels its build.
    const bool ends = moment && time % 4 == 3;
    if (moment) {
      moment->wait();
      EXPECT_EQ(ends ? lancer_scene_destroy(scene) : lancer_scene_cancel(scene), LANCER_OK);
    }
    const lancer_status status = ends ? LANCER_CANCELLED : finish_scene(scene);
    if (!ends && status == LANCER_CANCELLED) {
      EXPECT_EQ(lancer_scene_wait(scene, 0), LANCER_ERROR_STATE);
    }
    EXPECT_EQ(lancer_scene_destroy(scene), ends ? LANCER_ERROR_HANDLE : LANCER_OK);
    return status;
  }));
  EXPECT_GT(cancelled, repeats() / 8);
}

INSTANTIATE_TEST_SUITE_P(Trees, CancelledBuilds, testing::Values(LANCER_BVH, LANCER_KDTREE));

} // namespace
