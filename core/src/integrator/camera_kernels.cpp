#include "integrator/camera_kernel.h"

namespace lancer {

const CameraKernel &camera_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(camera_kernel); }

} // namespace lancer
