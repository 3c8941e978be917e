// The reader of a bake's texels, which finds their triangles in a committed scene.
#pragma once

#include "compile/scene.h"
#include "scene/bake.h"
#include "scene/camera.h"

struct lancer_bake;

namespace lancer {

// Throws Error for texels that do not fill the camera's picture. A texel on a triangle that is not there, or whose numbers are
// not weights, is empty.
Bake read_bake(const lancer_bake &source, const Scene &scene, const Camera &camera);

} // namespace lancer
