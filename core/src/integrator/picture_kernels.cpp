#include "integrator/picture_kernel.h"

namespace lancer {

const PictureKernel &picture_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(picture_kernel); }

} // namespace lancer
