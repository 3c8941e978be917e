#include "render/thread_pool.h"

#include "simd/parallel.h"
#include "simd/processor.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <thread>
#include <utility>

#if defined(__linux__)
#include <cerrno>
#include <sched.h>
#endif

namespace lancer {

namespace {

#if defined(__linux__)
using File = std::unique_ptr<std::FILE, decltype(&std::fclose)>;

File open(const std::string &path) { return {std::fopen(path.c_str(), "r"), &std::fclose}; }

// Returns the numbers at the start of a file; 0 for missing ones, as for the text "max".
std::array<double, 2> numbers(const std::string &path) {
  std::array<double, 2> found{};
  if (const File file = open(path))
    if (std::fscanf(file.get(), "%lf %lf", &found[0], &found[1]) < 1)
      return {};
  return found;
}

// Returns quota over period of one group; infinity where it has no limit.
double quota(const std::string &folder) {
  // Version 2: "max 100000" or "150000 100000".
  auto [time, period] = numbers(folder + "/cpu.max");
  if (time == 0.0) {
    // Version 1, where -1 is no limit.
    time = numbers(folder + "/cpu.cfs_quota_us")[0];
    period = numbers(folder + "/cpu.cfs_period_us")[0];
  }
  return time > 0.0 && period > 0.0 ? time / period : std::numeric_limits<double>::infinity();
}

// Returns the least quota of a group and its ancestors. Inside a container, the path may be that of the host, whose last part
// is the container's root.
double quota_of_all(const std::string &mount, std::string path) {
  double least = quota(mount);
  while (path.size() > 1) {
    least = std::min(least, quota(mount + path));
    path.resize(path.rfind('/'));
  }
  return least;
}

// Returns the least quota of the groups of this process, by the kernel's lines "number:controllers:path".
double quota_of_process(const std::string &root) {
  double least = std::numeric_limits<double>::infinity();
  const File file = open(root + "/proc/self/cgroup");
  std::array<char, 4096> text{};
  while (file && std::fgets(text.data(), int(text.size()), file.get())) {
    const std::string line(text.data(), std::strcspn(text.data(), "\n"));
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos)
      continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
    if (path.empty() || path[0] != '/')
      continue;
    const std::string mounts = root + "/sys/fs/cgroup";
    if (controllers.empty())
      least = std::min(least, quota_of_all(mounts, path));
    else if (("," + controllers + ",").find(",cpu,") != std::string::npos)
      least = std::min({least, quota_of_all(mounts + "/" + controllers, path), quota_of_all(mounts + "/cpu", path)});
  }
  return least;
}

// Returns the number of processors that the calling thread may run on; 0 where the kernel does not report it.
uint32_t allowed_processors() {
  for (int room = 1024; room <= 1 << 20; room *= 4) {
    cpu_set_t *const set = CPU_ALLOC(size_t(room));
    if (!set)
      return 0;
    const size_t size = CPU_ALLOC_SIZE(size_t(room));
    const bool known = sched_getaffinity(0, size, set) == 0;
    const int error = errno;
    const int count = known ? CPU_COUNT_S(size, set) : 0;
    CPU_FREE(set);
    if (known)
      return uint32_t(count);
    // EINVAL: the system has more processors than the set has bits.
    if (error != EINVAL)
      return 0;
  }
  return 0;
}
#endif

} // namespace

uint32_t usable_processors([[maybe_unused]] const std::string &root) {
  uint32_t count = std::max(1u, std::thread::hardware_concurrency());
#if defined(__linux__)
  if (const uint32_t allowed = allowed_processors())
    count = allowed;
  const double least = quota_of_process(root);
  // Round up: a quota of a fraction of a processor lets one more thread run for that fraction of the time.
  if (least < count)
    count = std::max(1u, uint32_t(std::ceil(least)));
#endif
  return count;
}

namespace {

// A block of this size is so small that free() does not return it to the system.
constexpr size_t kReserve = size_t(64) << 10;

// Allocates and frees a block, so that the next thread finds memory for prepare_to_fail(). Throws std::bad_alloc if there is
// none.
void reserve_memory() {
  const std::unique_ptr<char[]> memory(new char[kReserve]);
  // Keeps the compiler from removing the allocation.
  *static_cast<volatile char *>(memory.get()) = 0;
}

} // namespace

ThreadPool::ThreadPool(uint32_t count) {
  try {
    for (uint32_t i = 0, all = resolved(count); i < all; ++i) {
      reserve_memory();
      threads_.emplace_back([this, i] { loop(i); });
      std::unique_lock lock(mutex_);
      done_.wait(lock, [this] { return ready_ == size(); });
    }
  } catch (...) {
    // Not all threads could be started: end those that were, then rethrow.
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_all();
    for (std::thread &thread : threads_)
      thread.join();
    throw;
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread &thread : threads_)
    thread.join();
}

void ThreadPool::start(std::function<void(uint32_t)> work) {
  {
    const std::lock_guard lock(mutex_);
    work_ = std::move(work);
    failure_ = nullptr;
    busy_ = size();
    ++generation_;
  }
  wake_.notify_all();
}

bool ThreadPool::wait(uint32_t milliseconds) {
  std::unique_lock lock(mutex_);
  if (!done_.wait_for(lock, std::chrono::milliseconds(milliseconds), [this] { return busy_ == 0; }))
    return false;
  if (failure_)
    std::rethrow_exception(std::exchange(failure_, nullptr));
  return true;
}

bool ThreadPool::running() const {
  const std::lock_guard lock(mutex_);
  return busy_ > 0;
}

void ThreadPool::loop(uint32_t thread) {
  const FloatEnvironment environment;
  prepare_to_fail();
  uint64_t seen = 0;
  std::unique_lock lock(mutex_);
  ++ready_;
  done_.notify_all();
  while (true) {
    wake_.wait(lock, [&] { return stop_ || generation_ != seen; });
    if (stop_ && generation_ == seen)
      return;
    seen = generation_;
    lock.unlock();
    std::exception_ptr failure;
    try {
      // Call work_ itself: no other job replaces it before this one ends, and a copy would allocate memory.
      work_(thread);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure && !failure_)
      failure_ = failure;
    if (--busy_ == 0)
      done_.notify_all();
  }
}

} // namespace lancer
