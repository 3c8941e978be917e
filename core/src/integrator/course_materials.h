// Which materials the course's kernels can shade, and what they know of them.
#pragma once

#include "integrator/course_block.h"
#include "scene/material.h"

#include <vector>

namespace lancer {

// By number of material.
std::vector<WideCourse> make_course_materials(const std::vector<Material> &materials);

} // namespace lancer
