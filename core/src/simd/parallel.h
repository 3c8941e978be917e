// A parallel loop over independent pieces on the threads of a build.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <vector>

namespace lancer {

// Numbers of parts that a build made instead of taking them from an earlier one.
struct MadeCounts {
  std::atomic<uint32_t> placements{0}, mesh_trees{0}, triangles{0}, changed_meshes{0}, materials{0}, emitters{0}, skies{0},
      plane_searches{0};
};

struct BuildContext {
  uint32_t threads = 1;
  const std::atomic<bool> *cancel = nullptr; // polled; a cancelled build throws BuildCancelled
  MadeCounts *made = nullptr;                // null: nothing is counted
};

inline void count_made(const BuildContext &context, std::atomic<uint32_t> MadeCounts::*which, uint32_t count = 1) {
  if (context.made)
    (context.made->*which).fetch_add(count, std::memory_order_relaxed);
}
struct BuildCancelled {};

inline void poll_cancel(const BuildContext &context) {
  if (context.cancel && context.cancel->load(std::memory_order_relaxed))
    throw BuildCancelled{};
}

// Allocates the per-thread data of exceptions. The C++ runtime allocates these data on first use, and ends the process if there
// is no memory for them. So a thread calls this function before its work may use up all memory. volatile, because the compiler
// would remove an unused call.
inline void prepare_to_fail() { [[maybe_unused]] const volatile int exceptions = std::uncaught_exceptions(); }

// Calls piece(0) ... piece(count - 1) in any order; the first exception ends the loop and is rethrown here.
template <class Piece> void parallel_for(const BuildContext &context, size_t count, Piece &&piece) {
  std::atomic<size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    prepare_to_fail();
    try {
      for (size_t i; (i = next.fetch_add(1)) < count;) {
        poll_cancel(context);
        piece(i);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure)
        failure = std::current_exception();
      next = count;
    }
  };
  const size_t threads = std::min<size_t>(std::max(context.threads, 1u), count);
  std::vector<std::thread> helpers;
  helpers.reserve(threads);
  try {
    for (size_t i = 1; i < threads; ++i)
      helpers.emplace_back(work);
  } catch (const std::system_error &) {
    // The system has no more threads: continue with those created.
  } catch (const std::bad_alloc &) {
    // No memory for another thread.
  }
  work();
  for (std::thread &helper : helpers)
    helper.join();
  if (failure)
    std::rethrow_exception(failure);
}

} // namespace lancer
