// The number of threads for a process: its processors and the quotas of its control groups.
#include "render/thread_pool.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#if defined(__linux__)
#include <sched.h>

namespace {

namespace fs = std::filesystem;

// A file system with the kernel's files about control groups.
class Groups : public testing::Test {
protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    root_ = fs::path(testing::TempDir()) / ("lancer_groups_" + name);
    fs::remove_all(root_);
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string &path, const std::string &text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text << "\n";
  }
  uint32_t threads() const { return lancer::usable_processors(root_.string()); }

  fs::path root_;
};

// Runs work with the calling thread on one processor.
template <class Work> void on_one_processor(Work &&work) {
  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&one);
  for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i)
    if (CPU_ISSET(i, &all))
      CPU_SET(i, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  work();
  ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
}

TEST_F(Groups, WithoutLimitItIsTheProcessorsOfTheThread) {
  cpu_set_t all;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  EXPECT_EQ(threads(), uint32_t(CPU_COUNT(&all)));
  on_one_processor([&] { EXPECT_EQ(threads(), 1u); });
}

// Quotas below one processor, so that they limit any machine.
TEST_F(Groups, QuotasOfBothVersionsCount) {
  write("proc/self/cgroup", "0::/");
  write("sys/fs/cgroup/cpu.max", "50000 100000");
  EXPECT_EQ(threads(), 1u);
  write("proc/self/cgroup", "5:memory:/a\n4:cpu,cpuacct:/a\n0::/b");
  write("sys/fs/cgroup/cpu.max", "max 100000");
  const uint32_t free = threads();
  write("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "-1");
  write("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000");
  EXPECT_EQ(threads(), free);
  write("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "25000");
  EXPECT_EQ(threads(), 1u);
}

TEST_F(Groups, TheLeastQuotaAboveAProcessCounts) {
  write("proc/self/cgroup", "0::/outer/inner");
  write("sys/fs/cgroup/outer/inner/cpu.max", "max 100000");
  const uint32_t free = threads();
  write("sys/fs/cgroup/outer/cpu.max", "10000 100000");
  EXPECT_EQ(threads(), 1u);
  // A path of the host that is invisible in the container: its own group is the root.
  write("proc/self/cgroup", "0::/docker/0123");
  EXPECT_EQ(threads(), free);
  write("sys/fs/cgroup/cpu.max", "10000 100000");
  EXPECT_EQ(threads(), 1u);
}

TEST_F(Groups, AQuotaIsRoundedUpAndGivesNoMoreThanThereIs) {
  const uint32_t free = threads();
  write("proc/self/cgroup", "0::/");
  write("sys/fs/cgroup/cpu.max", "150000 100000");
  EXPECT_EQ(threads(), std::min(2u, free));
  write("sys/fs/cgroup/cpu.max", "100000000 100000");
  EXPECT_EQ(threads(), free);
  write("sys/fs/cgroup/cpu.max", "nonsense");
  EXPECT_EQ(threads(), free);
}

} // namespace
#endif
