#include "nodes/run.h"

namespace lancer {

const NodeKernel &node_kernel() { return LANCER_CHOSEN_KERNEL(node_kernel); }

} // namespace lancer
