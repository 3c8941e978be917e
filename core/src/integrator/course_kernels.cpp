#include "accel/instruction_set.h"
#include "integrator/course_kernel.h"

namespace lancer {

const CourseKernel &course_kernel() {
#if defined(__x86_64__)
  switch (instruction_set()) {
  case InstructionSet::Avx512:
    return avx512::course_kernel;
  case InstructionSet::Avx2:
    return avx2::course_kernel;
  default:
    return sse4::course_kernel;
  }
#else
  return generic::course_kernel;
#endif
}

} // namespace lancer
