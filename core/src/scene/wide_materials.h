// Which materials kernels can shade, and their records.
#pragma once

#include "bsdf/wide_lobe.h"
#include "scene/material.h"

#include <vector>

namespace lancer {

// By number of material; count 0 where the general code has to do it. Records of inner sides follow. All point into the
// materials' tables.
std::vector<WideMaterial> make_wide_materials(const std::vector<Material> &materials);

} // namespace lancer
