// Flat shading as in the course's texts: one colour for each polygon, computed at its centre.
#pragma once

#include "compile/scene.h"
#include "scene/surface.h"

namespace lancer {

inline bool is_flat(const Instance &instance) { return instance.kind == ShapeKind::Mesh && instance.shading == Shading::Flat; }

// The surface at the centre of the polygon that hit is of, about the polygon's normal. The instance is_flat.
Surface surface_at_center(const Scene &scene, const Hit &hit);

} // namespace lancer
