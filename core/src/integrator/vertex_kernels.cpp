#include "accel/instruction_set.h"
#include "integrator/vertex_kernel.h"

namespace lancer {

const VertexKernel &vertex_kernel() {
#if defined(__x86_64__)
  switch (instruction_set()) {
  case InstructionSet::Avx512:
    return avx512::vertex_kernel;
  case InstructionSet::Avx2:
    return avx2::vertex_kernel;
  default:
    return sse4::vertex_kernel;
  }
#else
  return generic::vertex_kernel;
#endif
}

} // namespace lancer
