#include "allocations.h"

#include <cstdlib>
#include <new>

namespace {

thread_local bool watched = false;
thread_local uint64_t calls = 0, allowed_calls = 0;

void *allocate(std::size_t size) noexcept {
  if (watched && calls++ >= allowed_calls)
    return nullptr;
  return std::malloc(size ? size : 1);
}

void *allocate_or_throw(std::size_t size) {
  if (void *memory = allocate(size))
    return memory;
  throw std::bad_alloc();
}

} // namespace

namespace lancer_test {

Allocations::Allocations(uint64_t allowed) {
  calls = 0;
  allowed_calls = allowed;
  watched = true;
}

Allocations::~Allocations() { watched = false; }

uint64_t Allocations::count() const { return calls; }

} // namespace lancer_test

// All forms except the aligned ones, so that memory from one form is never freed by another library's delete.
void *operator new(std::size_t size) { return allocate_or_throw(size); }
void *operator new[](std::size_t size) { return allocate_or_throw(size); }
void *operator new(std::size_t size, const std::nothrow_t &) noexcept { return allocate(size); }
void *operator new[](std::size_t size, const std::nothrow_t &) noexcept { return allocate(size); }
void operator delete(void *memory) noexcept { std::free(memory); }
void operator delete[](void *memory) noexcept { std::free(memory); }
void operator delete(void *memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void *memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void *memory, const std::nothrow_t &) noexcept { std::free(memory); }
void operator delete[](void *memory, const std::nothrow_t &) noexcept { std::free(memory); }
