// Memory of the calling thread, watched: how often it is asked for, and what happens when there is none.
#pragma once

#include <cstdint>
#include <limits>

namespace lancer_test {

// While it lives operator new counts this thread's calls, and refuses all after the first so many. One at a time.
class Allocations {
public:
  explicit Allocations(uint64_t allowed = std::numeric_limits<uint64_t>::max());
  ~Allocations();
  Allocations(const Allocations &) = delete;
  Allocations &operator=(const Allocations &) = delete;

  uint64_t count() const;
};

} // namespace lancer_test
