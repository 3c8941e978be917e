// Memory and threads of the whole process, watched: asked for, and refused where a test wants it.
#pragma once

#include <cstdint>

namespace lancer_test {

enum class Refuse {
  Nothing,
  One,       // that request alone
  AllFromIt, // that request and all that follow
};

// While it lives requests of all threads are numbered from 1, and refused from the given number on or at it alone. One at a
// time.
class Failing {
public:
  explicit Failing(Refuse refuse = Refuse::Nothing, uint64_t number = 0);
  ~Failing();
  Failing(const Failing &) = delete;
  Failing &operator=(const Failing &) = delete;

  uint64_t requests() const;
  bool refused() const;
};

// The pieces of memory that have been given and not been taken back.
int64_t live_memory();

} // namespace lancer_test
