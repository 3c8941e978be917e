// The processors that this process may use, and threads on them.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace lancer {

// Returns the number of processors that this process may use.

// This is the number of threads that can run at a time: at least 1, and fewer where the process's control group (cgroup version
// 1 or 2) has a quota of processor time. root: prefix of the file system's paths.
uint32_t usable_processors(const std::string &root = "");

// Threads that wait for work and can be observed from outside.

// The pool runs one job at a time on all of its threads. The first exception of a job is stored for the caller of wait().
class ThreadPool {
public:
  // count 0: one per processor that the process may use.
  explicit ThreadPool(uint32_t count);
  static uint32_t resolved(uint32_t count) { return count ? count : usable_processors(); }
  ~ThreadPool();
  ThreadPool(const ThreadPool &) = delete;
  ThreadPool &operator=(const ThreadPool &) = delete;

  uint32_t size() const { return uint32_t(threads_.size()); }
  // Starts work(thread) on every thread; no job may be running.
  void start(std::function<void(uint32_t thread)> work);
  // Waits at most the given time and returns whether the job is done. Rethrows the exception of the job, once.
  bool wait(uint32_t milliseconds);
  bool running() const;

private:
  void loop(uint32_t thread);

  mutable std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::function<void(uint32_t)> work_;
  std::exception_ptr failure_;
  uint64_t generation_ = 0;
  uint32_t busy_ = 0, ready_ = 0;
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

} // namespace lancer
