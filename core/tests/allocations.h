// Counts and refuses memory requests of the calling thread.
#pragma once

#include <cstdint>
#include <limits>

namespace lancer_test {

// During its lifetime operator new counts this thread's calls, and fails after the allowed number. One object at a time.
class Allocations {
public:
  explicit Allocations(uint64_t allowed = std::numeric_limits<uint64_t>::max());
  ~Allocations();
  Allocations(const Allocations &) = delete;
  Allocations &operator=(const Allocations &) = delete;

  uint64_t count() const;
};

} // namespace lancer_test
