// What holds after every call.
#pragma once

#include "lancer.h"

namespace lancer_fuzz {

[[noreturn]] void broken(const char *what, const char *detail);

// Every status is one of those that there are, none is a fault of the library's own, and an error has its sentence.
lancer_status checked(const char *call, lancer_status status);

#define LANCER_CHECKED(call) checked(#call, call)

} // namespace lancer_fuzz
