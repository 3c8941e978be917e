// The course's shading in vector registers, one copy per instruction set; all give the same bits, and those of the general
// code: Bsdf, sample() of point lights, course_light.h, leave().
#pragma once

#include "integrator/course_block.h"

namespace lancer {

struct CourseKernel {
  void (*look)(CourseBlock &block);
  void (*light)(const CourseBlock &block, const CourseLamp &lamp, CourseLit &lit);
};

// Each is the same source, course_kernel.cpp, compiled with LANCER_ISA set to the name.
#if defined(__x86_64__)
namespace sse4 {
extern const CourseKernel course_kernel;
}
namespace avx2 {
extern const CourseKernel course_kernel;
}
namespace avx512 {
extern const CourseKernel course_kernel;
}
#else
namespace generic {
extern const CourseKernel course_kernel;
}
#endif
// The one that this processor runs, or that LANCER_ISA asks for.
const CourseKernel &course_kernel();

} // namespace lancer
