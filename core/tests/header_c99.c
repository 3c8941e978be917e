/* The headers must stand alone in plain C: this file is compiled as strict C99 and includes nothing else. */
#include "lancer_probes.h"

/* One use, so that the translation unit is not empty. */
uint32_t lancer_test_abi_version_as_c(void) { return LANCER_ABI_VERSION; }
