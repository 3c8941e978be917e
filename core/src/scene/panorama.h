// Panoramic projections: a place of the whole picture, 0 ... 1, to a direction and back. Local frame: -z forwards, y up.
#pragma once

#include "scene/camera.h"

namespace lancer {

// Unit; zero where the panorama shows nothing.
glm::dvec3 panorama_direction(const Camera &camera, const glm::dvec2 &place);
// d: unit. The place that shows it, also beyond the picture's edge.
glm::dvec2 panorama_place(const Camera &camera, const glm::dvec3 &d);

} // namespace lancer
