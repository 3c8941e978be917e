// Sessions whose samples begin on a surface.
#pragma once

#include "states.h"

namespace lancer_fuzz {

// Creates a session of a scene that bakes random texels; filled: the scene's contents, or null. Its handle is 0 if refused.
SessionState bake(lancer_scene scene, const Filled *filled, Records &records, Bytes &bytes);

} // namespace lancer_fuzz
