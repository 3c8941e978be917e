// Where surfaces lie in one plane, one of them is there: the rule on top of any accelerator.
#pragma once

#include "accel/accelerator.h"
#include "accel/coplanar/plane_order.h"

namespace lancer {

// An accelerator with one rule more. Where two faces cover the same place of a plane, as far as rounding tells, the one is met
// that lets no light through, then one that shines, then the one of the smaller instance, of the smaller slot, of the smaller
// number: from either side, whichever is closer by rounding. A ray that starts on a face meets no other of its plane. A scene
// without such faces gets the plain accelerator.
std::unique_ptr<Accelerator> build_accelerator(AcceleratorKind kind, const Geometry &geometry, PlaneRules rules,
                                               const BuildContext &context);

} // namespace lancer
