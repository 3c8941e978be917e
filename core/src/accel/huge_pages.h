// Vectors for the large arrays that rays wander through.
#pragma once

#include "scene/large_memory.h"

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace lancer {

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
  // Elements that are not given a value have none: threads touch their own parts of new memory first.
  template <class U> void construct(U *element) { ::new (static_cast<void *>(element)) U; }
  template <class U, class... Values> void construct(U *element, Values &&...values) {
    ::new (static_cast<void *>(element)) U(std::forward<Values>(values)...);
  }
  void deallocate(T *memory, size_t) { free_aligned(memory); }
  template <class U> bool operator==(const HugePageAllocator<U> &) const { return true; }
};

template <class T> using HugeVector = std::vector<T, HugePageAllocator<T>>;

// Gives a vector's memory back; to assign {} would keep it.
template <class Vector> void release(Vector &vector) { Vector().swap(vector); }

} // namespace lancer
