// Exact surfaces in their unit frames: sphere, plane, cylinder, cone (lancer.h says which).
#pragma once

#include "accel/placed_shape.h"
#include "scene/exact_shape.h"
#include "scene/ray.h"

namespace lancer {

// The first t with tmin < t < tmax where the ray meets the surface; false where there is none.
// leaves: the ray starts on this surface, so the root that is its own start is left out.
bool intersect_quadric(const PlacedShape &shape, const Ray &ray, bool leaves, double &t);

} // namespace lancer
