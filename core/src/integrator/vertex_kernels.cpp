#include "integrator/vertex_kernel.h"

namespace lancer {

const VertexKernel &vertex_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(vertex_kernel); }

} // namespace lancer
