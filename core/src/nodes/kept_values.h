// Memory for values of nodes that are too many for the stack.
#pragma once

#include <cstddef>

namespace lancer {

// Aligned for lanes. Throws std::bad_alloc.
void *allocate_kept(size_t bytes);
void free_kept(void *values);

} // namespace lancer
