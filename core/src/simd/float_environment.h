// The processor's mode of float arithmetic.
#pragma once

#include <cstdint>

namespace lancer {

// Sets the processor's float arithmetic to round-to-nearest with subnormals during its lifetime: other code in the same process
// may have set another mode, which threads inherit.
class FloatEnvironment {
public:
  FloatEnvironment();
  ~FloatEnvironment();
  FloatEnvironment(const FloatEnvironment &) = delete;
  FloatEnvironment &operator=(const FloatEnvironment &) = delete;

private:
  uint64_t saved_;
};

} // namespace lancer
