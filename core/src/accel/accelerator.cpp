#include "accel/accelerator.h"

namespace lancer {

std::unique_ptr<Accelerator> build_accelerator(AcceleratorKind kind, const Geometry &geometry, const BuildContext &context) {
  switch (kind) {
  case AcceleratorKind::KdTree:
    return build_kdtree_accelerator(geometry, context);
  case AcceleratorKind::BruteForce:
    return build_brute_force(geometry);
  case AcceleratorKind::Bvh:
    break;
  }
  return build_bvh(geometry, context);
}

} // namespace lancer
