// Which of many lights to ask at a point, and which ones a ray may run into: a tree of clusters, sixteen to a branch. Clusters
// are chosen by the most that may arrive from each.
#pragma once

#include "lights/light_bounds.h"
#include "lights/light_kernel.h"
#include "simd/parallel.h"

#include <span>
#include <vector>

namespace lancer {

class LightTree {
public:
  LightTree() = default;
  // count: numbers are below it. Lights without energy are never chosen, and none is distant. Coordinates should be about 1024
  // at most. Throws BuildCancelled.
  LightTree(std::vector<DescribedLight> lights, uint32_t count, const BuildContext &context = {});

  bool empty() const { return branches_.empty(); }
  // Of all of it; energy in the user's units.
  const LightBounds &bounds() const { return bounds_; }

  // u in [0, 1): one number for the whole way down.
  LightChoice choose(const LightQuery &query, double u) const;
  // The same for several at once.
  static LightWalk walk(const LightQuery &query, double u);
  void choose(std::span<LightWalk> walks) const { kernel_->choose(tree(), walks.data(), uint32_t(walks.size())); }
  // With which choose() returns a light.
  double probability(const LightQuery &query, uint32_t number) const;

  // Calls visit(way, light) for all lights that the first ways may meet before they end. The tree is not empty.
  template <class Visit> void along(const SegmentBlock &segments, uint32_t count, Visit &&visit) const {
    kernel_->along(
        tree(), segments, count,
        [](void *context, uint32_t way, uint32_t light) {
          (*static_cast<std::remove_reference_t<Visit> *>(context))(way, light);
        },
        &visit);
  }

  size_t bytes() const {
    return branches_.size() * (sizeof(LightBranch) + sizeof(uint32_t)) + aims_.size() * sizeof(LightAim) +
           place_of_.size() * sizeof(uint32_t);
  }

private:
  struct Part {
    uint32_t begin, end, slot, depth; // slot: of the parent
  };
  struct Child {
    uint32_t begin, end;
    LightBounds bounds;
    double cost;
  };

  LightBranches tree() const { return {branches_.data(), aims_.empty() ? nullptr : aims_.data(), slot_of_.data()}; }
  void add_branch(const Part &part, std::vector<DescribedLight> &lights, std::vector<Part> &waiting);
  static void set(const Child &child, uint32_t i, const std::vector<DescribedLight> &lights, LightBranch &branch,
                  LightAim &aim);

  const LightKernel *kernel_ = nullptr;
  std::vector<LightBranch> branches_;
  std::vector<LightAim> aims_; // of each branch; empty where nothing is aimed
  std::vector<uint32_t> slot_of_;
  std::vector<uint32_t> place_of_; // slot by number of light; kNone: never chosen
  LightBounds bounds_;
  bool crowded_ = false;
};

} // namespace lancer
