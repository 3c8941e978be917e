// Calls of probes, with arguments from bytes.
#pragma once

#include "records.h"

namespace lancer_fuzz {

void probe_camera(lancer_session session, Bytes &bytes);
// filled: contents of the scene; null if unknown.
void probe_scene(lancer_scene scene, const Filled *filled, Bytes &bytes);
// Probes without a scene.
void probe_nothing(Bytes &bytes);

} // namespace lancer_fuzz
