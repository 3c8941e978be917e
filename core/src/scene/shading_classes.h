// Materials by the code that shades them: vertices of one class may stand side by side in lanes.
#pragma once

#include "scene/material.h"

namespace lancer {

// The number of each material's class. Materials without nodes share one where their lobes differ in numbers alone; one with
// nodes has a class of its own, as its program belongs to it.
std::vector<uint32_t> shading_classes(const std::vector<Material> &materials);

} // namespace lancer
