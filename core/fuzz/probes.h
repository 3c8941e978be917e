// Calls that only ask, with numbers out of bytes.
#pragma once

#include "records.h"

namespace lancer_fuzz {

void probe_camera(lancer_session session, Bytes &bytes);
// filled: what is in it; null where that is not known.
void probe_scene(lancer_scene scene, const Filled *filled, Bytes &bytes);
// What needs no scene.
void probe_nothing(Bytes &bytes);

} // namespace lancer_fuzz
