// Memory for large arrays on pages of 2 MiB, if the system has them, and vectors in it.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#elif defined(_WIN32)
#include <malloc.h>
#endif

namespace lancer {

// Large pages keep the addresses of an array in the processor's TLB.
inline constexpr size_t kLargePage = size_t(2) << 20;

// alignment: a power of two that divides bytes. Returns nullptr if there is not enough memory.
inline void *allocate_aligned(size_t alignment, size_t bytes) {
#if defined(_WIN32)
  return _aligned_malloc(bytes, alignment);
#else
  void *const memory = std::aligned_alloc(alignment, bytes);
#if defined(__linux__)
  // The call is a hint: without large pages, the memory is slower but valid.
  if (memory && alignment >= kLargePage)
    (void)madvise(memory, bytes, MADV_HUGEPAGE);
#endif
  return memory;
#endif
}

inline void free_aligned(void *memory) {
#if defined(_WIN32)
  _aligned_free(memory);
#else
  std::free(memory);
#endif
}

// An allocator for the large arrays that rays access randomly.
template <class T> struct HugePageAllocator {
  using value_type = T;

  HugePageAllocator() = default;
  template <class U> HugePageAllocator(const HugePageAllocator<U> &) {}

  T *allocate(size_t count) {
    if (count > (~size_t(0) - kLargePage) / sizeof(T))
      throw std::bad_alloc();
    size_t bytes = count * sizeof(T), alignment = alignof(T) < 64 ? 64 : alignof(T);
    if (bytes >= 4 * kLargePage)
      alignment = kLargePage;
    bytes = (bytes + alignment - 1) / alignment * alignment;
    void *memory = allocate_aligned(alignment, bytes);
    if (!memory)
      throw std::bad_alloc();
    return static_cast<T *>(memory);
  }
  // Elements without a value stay uninitialised: threads touch their own parts of new memory first.
  template <class U> void construct(U *element) { ::new (static_cast<void *>(element)) U; }
  template <class U, class... Values> void construct(U *element, Values &&...values) {
    ::new (static_cast<void *>(element)) U(std::forward<Values>(values)...);
  }
  void deallocate(T *memory, size_t) { free_aligned(memory); }
  template <class U> bool operator==(const HugePageAllocator<U> &) const { return true; }
};

template <class T> using HugeVector = std::vector<T, HugePageAllocator<T>>;

// Frees a vector's memory; assigning {} would keep it.
template <class Vector> void release(Vector &vector) { Vector().swap(vector); }

} // namespace lancer
