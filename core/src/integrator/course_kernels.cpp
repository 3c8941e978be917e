#include "integrator/course_kernel.h"

namespace lancer {

const CourseKernel &course_kernel() { return LANCER_CHOSEN_KERNEL(course_kernel); }

} // namespace lancer
