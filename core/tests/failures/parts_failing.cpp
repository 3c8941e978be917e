// Parts without memory: each call reports it, and a session whose range failed takes and gives no parts.
#include "failing.h"

#include "../parts_lab.h"

namespace {

using namespace lancer_test;

class PartsFailing : public testing::Test {
protected:
  const lancer_scene scene = named_scene();
  const lancer_settings settings = settings_of_parts();
  const lancer_camera camera = make_camera(6, 5);
  const std::vector<lancer_range> range = {{0, 0, 3}, {1, 2, 1}};

  ~PartsFailing() override { lancer_scene_destroy(scene); }

  Bytes part() const {
    const Owned source(scene, settings, camera);
    return rendered(source.handle, range);
  }
};

TEST_F(PartsFailing, AFailedRangeIsNoPart) {
  const Bytes part = this->part();
  uint32_t failed = 0;
  bool refused = true;
  for (uint64_t number = 1; refused; ++number) {
    SCOPED_TRACE("request " + std::to_string(number));
    const Owned session(scene, settings, camera);
    lancer_status started, ended = LANCER_OK;
    {
      const Failing failing(Refuse::One, number);
      started = lancer_session_render_ranges(session.handle, uint32_t(range.size()), range.data());
      if (started == LANCER_OK)
        ended = finish(session.handle);
      refused = failing.refused();
    }
    ASSERT_TRUE(started == LANCER_OK || started == LANCER_ERROR_MEMORY) << lancer_last_error();
    ASSERT_TRUE(ended == LANCER_OK || ended == LANCER_ERROR_MEMORY) << lancer_last_error();
    if (ended == LANCER_OK)
      continue;
    ++failed;
    EXPECT_EQ(lancer_session_export(session.handle, nullptr, 0, nullptr), LANCER_ERROR_STATE);
    EXPECT_EQ(import(session.handle, part), LANCER_ERROR_STATE);
    EXPECT_NE(std::string(lancer_last_error()).find("a range failed"), std::string::npos) << lancer_last_error();
  }
  EXPECT_GT(failed, 5u);
}

TEST_F(PartsFailing, EveryImportIsWholeOrNothing) {
  const Bytes part = this->part();
  uint64_t number = 1;
  for (bool refused = true; refused; ++number) {
    SCOPED_TRACE("request " + std::to_string(number));
    const Owned joiner(0, settings, camera);
    const Bytes before = exported(joiner.handle);
    lancer_status status;
    {
      const Failing failing(Refuse::One, number);
      status = import(joiner.handle, part);
      refused = failing.refused();
    }
    EXPECT_EQ(status, refused ? LANCER_ERROR_MEMORY : LANCER_OK) << lancer_last_error();
    EXPECT_EQ(exported(joiner.handle), refused ? before : part);
  }
  EXPECT_GT(number, 20u);
}

} // namespace
