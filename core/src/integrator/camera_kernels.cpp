#include "accel/instruction_set.h"
#include "integrator/camera_kernel.h"

namespace lancer {

const CameraKernel &camera_kernel() {
#if defined(__x86_64__)
  switch (instruction_set()) {
  case InstructionSet::Avx512:
    return avx512::camera_kernel;
  case InstructionSet::Avx2:
    return avx2::camera_kernel;
  default:
    return sse4::camera_kernel;
  }
#else
  return generic::camera_kernel;
#endif
}

} // namespace lancer
