// Invariants of every call.
#pragma once

#include "lancer.h"

namespace lancer_fuzz {

[[noreturn]] void broken(const char *what, const char *detail);

// Checks that the status is defined and not an internal error, and that an error has a message.
lancer_status checked(const char *call, lancer_status status);

#define LANCER_CHECKED(call) checked(#call, call)

} // namespace lancer_fuzz
