// The loop over threads, where the system has no memory for one: allocations of one thread can be made to fail.
#include "accel/parallel.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

namespace {

// Allocations of this thread that still succeed.
thread_local long allowed = std::numeric_limits<long>::max();

} // namespace

void *operator new(std::size_t size) {
  if (allowed <= 0)
    throw std::bad_alloc();
  if (allowed != std::numeric_limits<long>::max())
    --allowed;
  if (void *memory = std::malloc(size > 0 ? size : 1))
    return memory;
  throw std::bad_alloc();
}
void operator delete(void *memory) noexcept { std::free(memory); }
void operator delete(void *memory, std::size_t) noexcept { std::free(memory); }

namespace lancer {
namespace {

TEST(Parallel, WithoutMemoryForAThreadTheOthersWork) {
  const BuildContext context{.threads = 64};
  // From no thread at all to some of them: what is missing is noticed before the first, or work goes on with fewer.
  for (long left = 0; left < 12; ++left) {
    std::atomic<int> done{0};
    bool refused = false;
    allowed = left;
    try {
      parallel_for(context, 1000, [&](size_t) { ++done; });
    } catch (const std::bad_alloc &) {
      refused = true;
    }
    allowed = std::numeric_limits<long>::max();
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
