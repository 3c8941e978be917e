#include "accel/instruction_set.h"
#include "integrator/picture_kernel.h"

namespace lancer {

const PictureKernel &picture_kernel() {
#if defined(__x86_64__)
  switch (instruction_set()) {
  case InstructionSet::Avx512:
    return avx512::picture_kernel;
  case InstructionSet::Avx2:
    return avx2::picture_kernel;
  default:
    return sse4::picture_kernel;
  }
#else
  return generic::picture_kernel;
#endif
}

} // namespace lancer
