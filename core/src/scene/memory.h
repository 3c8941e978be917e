// A check of requests against the machine's memory.
#pragma once

#include <string>

namespace lancer {

// Returns the machine's memory, in bytes.
double physical_memory();

// Throws an Error if bytes exceed the memory. what: "image 'Sky': 65536 x 65536 texels".
void check_memory(const std::string &what, double bytes);

} // namespace lancer
