#include "accel/instruction_set.h"
#include "lights/light_kernel.h"

namespace lancer {

const LightKernel &light_kernel() {
#if defined(__x86_64__)
  switch (instruction_set()) {
  case InstructionSet::Avx512:
    return avx512::light_kernel;
  case InstructionSet::Avx2:
    return avx2::light_kernel;
  default:
    return sse4::light_kernel;
  }
#else
  return generic::light_kernel;
#endif
}

} // namespace lancer
