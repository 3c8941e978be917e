#include "integrator/classic/classic_kernel.h"

namespace lancer {

const ClassicKernel &classic_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(classic_kernel); }

} // namespace lancer
