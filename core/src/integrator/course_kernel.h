// The course's shading in vector registers, one copy per instruction set; all give the same bits, and those of the general
// code: Bsdf, sample() of point lights, course_light.h, leave().
#pragma once

#include "accel/kernel_choice.h"
#include "integrator/course_block.h"

namespace lancer {

struct CourseKernel {
  void (*look)(CourseBlock &block);
  void (*light)(const CourseBlock &block, const CourseLamp &lamp, CourseLit &lit);
};

// Each is the same source, course_kernel.cpp, compiled with LANCER_ISA set to the name.
LANCER_DECLARE_KERNEL(CourseKernel, course_kernel)

} // namespace lancer
