// Counts and refuses requests for memory and threads of the whole process.
#pragma once

#include <cstdint>

namespace lancer_test {

enum class Refuse {
  Nothing,
  One,       // this request only
  AllFromIt, // this request and all later ones
};

// During its lifetime requests of all threads are numbered from 1, and refused at the given number or from it on. One object at
// a time.
class Failing {
public:
  explicit Failing(Refuse refuse = Refuse::Nothing, uint64_t number = 0);
  ~Failing();
  Failing(const Failing &) = delete;
  Failing &operator=(const Failing &) = delete;

  uint64_t requests() const;
  bool refused() const;
};

// Returns the number of live allocations.
int64_t live_memory();

} // namespace lancer_test
