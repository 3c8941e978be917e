#include "compile/prepare.h"

#include "accel/bvh/bvh_build.h"
#include "accel/mesh_bounds.h"
#include "simd/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

#if defined(__linux__)
#include <sys/resource.h>
#endif

namespace lancer {

namespace {

// Meshes with fewer triangles get one thread: starting others takes longer than they save.
constexpr size_t kLarge = 65536;
// How long a thread waits for the next mesh: to start another one takes as long as the tree of a small mesh.
constexpr std::chrono::milliseconds kPatience{20};

void make_tree(const Mesh &mesh, uint32_t threads, const std::atomic<bool> &cancel) {
  const BuildContext context{mesh.triangles.size() < kLarge ? 1 : threads, &cancel};
  tree_of(mesh, &mesh, mesh_frame(bounds_of(mesh, &mesh)->faces), context);
}

// On Linux a nice value belongs to a thread, and the threads that it creates inherit it.
void lower_priority() {
#if defined(__linux__)
  constexpr int kSteps = 5;
  setpriority(PRIO_PROCESS, 0, std::min(19, getpriority(PRIO_PROCESS, 0) + kSteps));
#endif
}

struct Wish {
  std::weak_ptr<const Mesh> mesh;
  uint32_t threads;
};

class Queue {
public:
  // Waits for the thread, when the process ends or unloads the library.
  ~Queue() {
    std::unique_lock lock(mutex_);
    cancel_ = true;
    wished_.notify_all();
    ended_.wait(lock, [&] { return !works_; });
  }

  void add(const Wish &wish) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(wish);
    if (works_) {
      wished_.notify_one();
      return;
    }
    try {
      std::thread([this] { work(); }).detach();
      works_ = true;
    } catch (const std::system_error &) {
      // The system gives no more threads: commits do all of the work.
      waiting_.clear();
    }
  }

private:
  void work() {
    prepare_to_fail();
    lower_priority();
    uint32_t threads = 0;
    while (const std::shared_ptr<const Mesh> mesh = next(threads)) {
      try {
        make_tree(*mesh, threads, cancel_);
      } catch (const BuildCancelled &) {
        // The process ends.
      } catch (const std::bad_alloc &) {
        // The commit reports the lack of memory.
      }
    }
  }

  // Returns null if the thread must end.
  std::shared_ptr<const Mesh> next(uint32_t &threads) {
    std::unique_lock lock(mutex_);
    while (wished_.wait_for(lock, kPatience, [&] { return !waiting_.empty() || cancel_; }) && !cancel_) {
      const std::shared_ptr<const Mesh> mesh = waiting_.front().mesh.lock();
      threads = waiting_.front().threads;
      waiting_.pop_front();
      if (mesh)
        return mesh;
    }
    works_ = false;
    ended_.notify_all();
    return nullptr;
  }

  std::mutex mutex_;
  std::condition_variable wished_, ended_;
  std::deque<Wish> waiting_;
  std::atomic<bool> cancel_{false};
  bool works_ = false;
};

} // namespace

void prepare(const std::shared_ptr<const Mesh> &mesh, uint32_t threads) {
  if (mesh->triangles.size() <= kMostUnfolded)
    return;
  static Queue queue;
  queue.add({mesh, threads});
}

} // namespace lancer
