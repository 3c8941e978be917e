// Where flat shading computes the one colour of a polygon.
#pragma once

#include "accel/ray.h"
#include "scene/geometry.h"

namespace lancer {

// By polygon number. The normal is the sum of the triangles' area vectors (Newell's). A centre is the mean of the polygon's
// vertices; of a warped polygon the place straight above or below it, along the normal; of a concave one that does not hold it
// the nearest place.
std::vector<PolygonCenter> polygon_centers(const Mesh &mesh);

// The hit of the same mesh at the centre of the polygon that hit is of; t stays. A triangle that belongs to no polygon is one.
Hit center_hit(const Mesh &mesh, const Hit &hit);

} // namespace lancer
