// Numbers of 113 bits, for references: the name of their type on this system.
#pragma once

#include <cfloat>

namespace lancer::test {

#if LDBL_MANT_DIG == 113
using Quad = long double;
#else
__extension__ using Quad = __float128;
#endif

} // namespace lancer::test
