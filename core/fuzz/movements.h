// Calls for what moves: the shutter, cameras, instances and their places in other frames; and for facts of instances.
#pragma once

#include "records.h"

namespace lancer_fuzz {

// Calls one of them for a scene; filled: its contents, or null.
void move(lancer_scene scene, const Filled *filled, Records &records, Bytes &bytes);

} // namespace lancer_fuzz
