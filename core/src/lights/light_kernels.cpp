#include "lights/light_kernel.h"

namespace lancer {

const LightKernel &light_kernel() { return LANCER_CHOSEN_KERNEL(light_kernel); }

} // namespace lancer
