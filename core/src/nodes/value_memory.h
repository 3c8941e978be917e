// Memory for values of nodes that are too many for the stack.
#pragma once

#include <cstddef>

namespace lancer {

// Aligned for lanes. Throws std::bad_alloc.
void *allocate_values(size_t bytes);
void free_values(void *values);

} // namespace lancer
