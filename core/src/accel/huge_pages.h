// Memory for the large arrays that rays wander through: on pages of 2 MiB where the system has them, so that their addresses
// stay in the processor's tables.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace lancer {

template <class T> struct HugePageAllocator {
  using value_type = T;

  HugePageAllocator() = default;
  template <class U> HugePageAllocator(const HugePageAllocator<U> &) {}

  T *allocate(size_t count) {
    constexpr size_t kPage = size_t(1) << 21;
    if (count > (~size_t(0) - kPage) / sizeof(T))
      throw std::bad_alloc();
    size_t bytes = count * sizeof(T), alignment = alignof(T) < 64 ? 64 : alignof(T);
    if (bytes >= 4 * kPage)
      alignment = kPage;
    bytes = (bytes + alignment - 1) / alignment * alignment;
    void *memory = std::aligned_alloc(alignment, bytes);
    if (!memory)
      throw std::bad_alloc();
#if defined(__linux__)
    // A wish: without it, everything works on small pages.
    if (alignment == kPage)
      madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return static_cast<T *>(memory);
  }
  // Elements that are not given a value have none: threads touch their own parts of new memory first.
  template <class U> void construct(U *element) { ::new (static_cast<void *>(element)) U; }
  template <class U, class... Values> void construct(U *element, Values &&...values) {
    ::new (static_cast<void *>(element)) U(std::forward<Values>(values)...);
  }
  void deallocate(T *memory, size_t) { std::free(memory); }
  template <class U> bool operator==(const HugePageAllocator<U> &) const { return true; }
};

template <class T> using HugeVector = std::vector<T, HugePageAllocator<T>>;

// Gives a vector's memory back; to assign {} would keep it.
template <class Vector> void release(Vector &vector) { Vector().swap(vector); }

} // namespace lancer
