// The random numbers of vertices: also lanes without a sample hold numbers from which kernels may look up tables.
#include "integrator/stages/numbers.h"

#include <cstddef>
#include <gtest/gtest.h>
#include <new>

namespace lancer_test {
namespace {

// Memory as another object may have left it: every float of it is 3e38.
template <class T> class UsedMemory {
public:
  UsedMemory() {
    for (volatile std::byte &byte : bytes_)
      byte = std::byte{0x7f};
    new (bytes_) T;
  }
  UsedMemory(const UsedMemory &) = delete;
  UsedMemory &operator=(const UsedMemory &) = delete;
  ~UsedMemory() { object().~T(); }
  T &object() { return *std::launder(reinterpret_cast<T *>(bytes_)); }

private:
  alignas(T) std::byte bytes_[sizeof(T)];
};

TEST(VertexNumbers, LanesWithoutASampleHoldNumbers) {
  UsedMemory<lancer::NumberStage> memory;
  lancer::NumberStage &stage = memory.object();
  // Lanes of different dimensions are drawn one by one, at every width.
  for (uint32_t lane = 0; lane < 2; ++lane)
    stage.set(lane, lancer::Sampler(0, 1, 2, 3), lancer::kDimensionVertex + lane * lancer::kVertexStride);
  stage.draw(lancer::kLightNumbers | lancer::kPathNumbers, 2);
  for (const auto &of : stage.numbers.of)
    for (const float u : of) {
      EXPECT_GE(u, 0.0f);
      EXPECT_LT(u, 1.0f);
    }
}

} // namespace
} // namespace lancer_test
