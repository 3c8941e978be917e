// Bytes as a program: calls of the C interface one after the other, and what must hold after each.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lancer_fuzz {

// Runs the calls that the bytes stand for, then whatever is missing up to a read picture, and frees all. Ends the process with
// words where a promise of the interface is broken.
void run_program(const uint8_t *data, size_t size);

} // namespace lancer_fuzz
