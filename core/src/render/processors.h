// The number of processors that this process may use.
#pragma once

#include <cstdint>
#include <string>

namespace lancer {

// Threads that can run at a time: the processors that the process may run on, fewer where its control group (1 or 2) has a
// quota of processor time. At least 1. root: where the file system begins.
uint32_t usable_processors(const std::string &root = "");

} // namespace lancer
