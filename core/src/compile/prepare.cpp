#include "compile/prepare.h"

#include "accel/bvh/bvh_build.h"
#include "accel/mesh_bounds.h"
#include "simd/parallel.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#if defined(__linux__)
#include <sys/resource.h>
#endif

namespace lancer {

namespace {

// A commit that waits for a tree helps nobody: the tree gets as many threads as the commit would give it.
BuildContext context_of(const Mesh &mesh, const std::atomic<bool> &cancel) {
  constexpr size_t kLarge = 65536;
  return {mesh.triangles.size() < kLarge ? 1u : std::max(1u, std::thread::hardware_concurrency()), &cancel};
}

void make_tree(const Mesh &mesh, const std::atomic<bool> &cancel) {
  if (mesh.triangles.size() <= kMostUnfolded)
    return;
  const PlacementFrame frame = mesh_frame(bounds_of(mesh, &mesh)->faces);
  tree_of(mesh, &mesh, frame, context_of(mesh, cancel));
}

// On Linux a nice value belongs to a thread, and the threads that it creates inherit it.
void lower_priority() {
#if defined(__linux__)
  constexpr int kSteps = 5;
  setpriority(PRIO_PROCESS, 0, std::min(19, getpriority(PRIO_PROCESS, 0) + kSteps));
#endif
}

class Queue {
public:
  // Waits for the thread, when the process ends or unloads the library.
  ~Queue() {
    cancel_ = true;
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [&] { return !works_; });
  }

  void add(const std::shared_ptr<const Mesh> &mesh) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(mesh);
    if (works_)
      return;
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
    while (const std::shared_ptr<const Mesh> mesh = next()) {
      try {
        make_tree(*mesh, cancel_);
      } catch (const BuildCancelled &) {
        // The process ends.
      } catch (const std::bad_alloc &) {
        // The commit reports the lack of memory.
      }
    }
  }

  // Returns null if the thread must end.
  std::shared_ptr<const Mesh> next() {
    const std::lock_guard lock(mutex_);
    while (!waiting_.empty() && !cancel_) {
      const std::shared_ptr<const Mesh> mesh = waiting_.front().lock();
      waiting_.pop_front();
      if (mesh)
        return mesh;
    }
    works_ = false;
    ended_.notify_all();
    return nullptr;
  }

  std::mutex mutex_;
  std::condition_variable ended_;
  std::deque<std::weak_ptr<const Mesh>> waiting_;
  std::atomic<bool> cancel_{false};
  bool works_ = false;
};

} // namespace

void prepare(const std::shared_ptr<const Mesh> &mesh) {
  static Queue queue;
  queue.add(mesh);
}

} // namespace lancer
