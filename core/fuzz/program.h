// Bytes as a program: a sequence of calls of the C interface, and invariants after each.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lancer_fuzz {

// Runs the calls encoded by the bytes, then the missing ones up to a read picture, and frees everything. Aborts with a message
// if the interface breaks a promise.
void run_program(const uint8_t *data, size_t size);

} // namespace lancer_fuzz
