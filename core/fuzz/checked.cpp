#include "checked.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace lancer_fuzz {

[[noreturn]] void broken(const char *what, const char *detail) {
  std::fprintf(stderr, "broken promise: %s: %s\n", what, detail);
  std::abort();
}

lancer_status checked(const char *call, lancer_status status) {
  const char *said = lancer_last_error();
  if (status < LANCER_OK || status >= LANCER_ERROR_INTERNAL)
    broken(call, said);
  if ((status >= LANCER_ERROR_ARGUMENT) != (*said != '\0'))
    broken(call, "its status and its message do not agree");
  if (std::strlen(said) > 1023)
    broken(call, "its message is too long");
  return status;
}

} // namespace lancer_fuzz
