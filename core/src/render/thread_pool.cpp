#include "render/thread_pool.h"

#include "accel/parallel.h"

#include <algorithm>
#include <cfenv>
#include <chrono>
#include <memory>
#include <utility>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace lancer {

namespace {

// Small enough that freeing it does not give it back to the system.
constexpr size_t kReserve = size_t(64) << 10;

// What is free afterwards is there for prepare_to_fail(); without any the pool fails with words.
void reserve_memory() {
  const std::unique_ptr<char[]> memory(new char[kReserve]);
  // Not to be left out by the compiler.
  *static_cast<volatile char *>(memory.get()) = 0;
}

#if defined(__SSE2__)
// Every exception is masked; the rest is zero.
constexpr uint64_t kPlainFloats = 0x1f80;
uint64_t float_control() { return _mm_getcsr(); }
void set_float_control(uint64_t value) { _mm_setcsr(static_cast<uint32_t>(value)); }
#elif defined(__aarch64__)
constexpr uint64_t kPlainFloats = 0;
uint64_t float_control() {
  uint64_t value;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}
void set_float_control(uint64_t value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
#else
// What C knows of: the rounding.
constexpr uint64_t kPlainFloats = FE_TONEAREST;
uint64_t float_control() { return uint64_t(std::fegetround()); }
void set_float_control(uint64_t value) { std::fesetround(int(value)); }
#endif

} // namespace

FloatEnvironment::FloatEnvironment() : saved_(float_control()) { set_float_control(kPlainFloats); }
FloatEnvironment::~FloatEnvironment() { set_float_control(saved_); }

ThreadPool::ThreadPool(uint32_t count) {
  try {
    for (uint32_t i = 0, all = resolved(count); i < all; ++i) {
      reserve_memory();
      threads_.emplace_back([this, i] { loop(i); });
      std::unique_lock lock(mutex_);
      done_.wait(lock, [this] { return ready_ == size(); });
    }
  } catch (...) {
    // Not all threads could be had: end those that were, then tell.
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
      // No other work comes before this one is done: a copy, which takes memory, is not needed.
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
