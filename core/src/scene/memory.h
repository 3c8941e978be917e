// What is refused before it takes the machine down: things that are larger than its memory.
#pragma once

#include <string>

namespace lancer {

// The machine's memory, in bytes.
double physical_memory();

// what: "image 'Sky': 65536 x 65536 texels".
void check_memory(const std::string &what, double bytes);

} // namespace lancer
