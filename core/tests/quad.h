// Numbers of 113 bits, for references: what this system calls them.
#pragma once

#include <cfloat>

namespace lancer::test {

#if LDBL_MANT_DIG == 113
using Quad = long double;
#else
__extension__ using Quad = __float128;
#endif

} // namespace lancer::test
