// Memory for large arrays: on pages of 2 MiB where the system has them, so that their addresses stay in the processor's tables.
#pragma once

#include <cstddef>
#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#elif defined(_WIN32)
#include <malloc.h>
#endif

namespace lancer {

inline constexpr size_t kLargePage = size_t(2) << 20;

// alignment: a power of two that divides bytes. nullptr where there is no memory.
inline void *allocate_aligned(size_t alignment, size_t bytes) {
#if defined(_WIN32)
  return _aligned_malloc(bytes, alignment);
#else
  void *const memory = std::aligned_alloc(alignment, bytes);
#if defined(__linux__)
  // A hint: without large pages everything works, slower.
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

} // namespace lancer
