// The parallel loop, also without memory for its threads.
#include "allocations.h"

#include "simd/parallel.h"

#include <gtest/gtest.h>
#include <stdexcept>

namespace lancer {
namespace {

TEST(Parallel, WithoutMemoryForAThreadTheOthersWork) {
  const BuildContext context{.threads = 64};
  // From no thread to several: failure is reported before the first thread, or work continues with fewer.
  for (uint64_t left = 0; left < 12; ++left) {
    std::atomic<int> done{0};
    bool refused = false;
    try {
      const lancer_test::Allocations allocations(left);
      parallel_for(context, 1000, [&](size_t) { ++done; });
    } catch (const std::bad_alloc &) {
      refused = true;
    }
    EXPECT_EQ(done, refused ? 0 : 1000) << left;
    EXPECT_EQ(refused, left == 0);
  }
}

TEST(Parallel, TheFirstExceptionEndsIt) {
  for (const uint32_t threads : {1u, 4u}) {
    std::atomic<int> done{0};
    const auto piece = [&](size_t i) {
      ++done;
      if (i == 10)
        throw std::runtime_error("ten");
    };
    EXPECT_THROW(parallel_for(BuildContext{.threads = threads}, 1u << 20, piece), std::runtime_error);
    // The number of pieces that other threads finish before they stop depends on the system.
    if (threads == 1) {
      EXPECT_EQ(done, 11);
    }
  }
}

TEST(Parallel, CanBeCancelled) {
  std::atomic<bool> cancel{true};
  EXPECT_THROW(parallel_for(BuildContext{.threads = 2, .cancel = &cancel}, 10, [](size_t) { ADD_FAILURE(); }), BuildCancelled);
}

} // namespace
} // namespace lancer
