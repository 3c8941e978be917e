#include "failing.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <dlfcn.h>
#include <new>
#include <pthread.h>

namespace {

using lancer_test::Refuse;

std::atomic<Refuse> refuse{Refuse::Nothing};
std::atomic<uint64_t> asked{0}, refused_number{0};
std::atomic<bool> was_refused{false};
std::atomic<int64_t> live{0};

bool refuse_now() {
  const uint64_t number = ++asked;
  const Refuse how = refuse;
  if (how == Refuse::Nothing || number < refused_number || (how == Refuse::One && number > refused_number))
    return false;
  was_refused = true;
  return true;
}

void *allocate(std::size_t size) noexcept {
  void *memory = refuse_now() ? nullptr : std::malloc(size ? size : 1);
  live += memory != nullptr;
  return memory;
}

void *allocate_or_throw(std::size_t size) {
  if (void *memory = allocate(size))
    return memory;
  throw std::bad_alloc();
}

void give_back(void *memory) noexcept {
  live -= memory != nullptr;
  std::free(memory);
}

// Returns the system's function of that name, which this file's function hides.
template <class Function> Function *next_of(const char *name) {
  return reinterpret_cast<Function *>(dlsym(RTLD_NEXT, name)); // NOLINT: required by dlsym
}

} // namespace

namespace lancer_test {

Failing::Failing(Refuse how, uint64_t number) {
  asked = 0;
  was_refused = false;
  refused_number = number;
  refuse = how;
}

Failing::~Failing() { refuse = Refuse::Nothing; }

uint64_t Failing::requests() const { return asked; }

bool Failing::refused() const { return was_refused; }

int64_t live_memory() { return live; }

} // namespace lancer_test

// All forms except the aligned ones, so that memory from one form is never freed by another library's delete.
void *operator new(std::size_t size) { return allocate_or_throw(size); }
void *operator new[](std::size_t size) { return allocate_or_throw(size); }
void *operator new(std::size_t size, const std::nothrow_t &) noexcept { return allocate(size); }
void *operator new[](std::size_t size, const std::nothrow_t &) noexcept { return allocate(size); }
void operator delete(void *memory) noexcept { give_back(memory); }
void operator delete[](void *memory) noexcept { give_back(memory); }
void operator delete(void *memory, std::size_t) noexcept { give_back(memory); }
void operator delete[](void *memory, std::size_t) noexcept { give_back(memory); }
void operator delete(void *memory, const std::nothrow_t &) noexcept { give_back(memory); }
void operator delete[](void *memory, const std::nothrow_t &) noexcept { give_back(memory); }

// The program's definitions precede those of its libraries: allocations of tree nodes and images and of std::thread arrive
// here.
extern "C" void *aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  static auto *const next = next_of<void *(std::size_t, std::size_t)>("aligned_alloc");
  return refuse_now() ? nullptr : next(alignment, size);
}

extern "C" int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*body)(void *),
                              void *argument) noexcept {
  static auto *const next = next_of<int(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *)>("pthread_create");
  return refuse_now() ? EAGAIN : next(thread, attributes, body, argument);
}
