// The loop over threads, also where the system has no memory for one.
#include "allocations.h"

#include "simd/parallel.h"

#include <gtest/gtest.h>
#include <stdexcept>

namespace lancer {
namespace {

TEST(Parallel, WithoutMemoryForAThreadTheOthersWork) {
  const BuildContext context{.threads = 64};
  // From no thread at all to some of them: what is missing is noticed before the first, or work goes on with fewer.
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
    // How far the others come until they hear of it is the system's affair.
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
