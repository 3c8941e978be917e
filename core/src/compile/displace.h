// True displacement: vertices moved by what their materials say, once, before the scene is built.
#pragma once

#include "scene/description.h"
#include "simd/parallel.h"

namespace lancer {

// Moves the vertices of every mesh whose materials displace, and makes their normals anew. A mesh that instances show with
// different displacing materials is copied for each list of them.
void displace(Description &description, const BuildContext &context);

} // namespace lancer
