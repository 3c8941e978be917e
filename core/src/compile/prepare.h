// Work of later commits, done ahead of them by a thread of the library.
#pragma once

#include "scene/geometry.h"

#include <memory>

namespace lancer {

// Queues the mesh's tree, if it gets one of its own. The thread ends soon after nothing is left; its priority is lower than
// that of the calling thread. A mesh that nobody has when its turn comes is left out. threads: the most that build the tree; at
// least 1.
void prepare(const std::shared_ptr<const Mesh> &mesh, uint32_t threads);

} // namespace lancer
