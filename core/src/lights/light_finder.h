// Which lights a ray may run into: a tree of boxes.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lancer {

class LightFinder {
public:
  struct Box {
    glm::dvec3 low{0.0}, high{0.0};
    uint32_t light = 0;
  };

  LightFinder() = default;
  explicit LightFinder(std::vector<Box> boxes);

  bool empty() const { return nodes_.empty(); }
  // Calls visit(light) for all lights whose boxes the way from o along the unit wi passes, up to the distance end.
  template <class Visit> void along(const glm::dvec3 &o, const glm::dvec3 &wi, double end, Visit &&visit) const {
    const glm::dvec3 inverse = 1.0 / wi;
    uint32_t waiting[kDeepest];
    int depth = 0;
    for (uint32_t number = 0; number < nodes_.size();) {
      const Node &node = nodes_[number];
      if (passes(node.box, o, inverse, end)) {
        if (node.inner) {
          waiting[depth++] = node.second;
          ++number;
          continue;
        }
        visit(node.box.light);
      }
      if (depth == 0)
        break;
      number = waiting[--depth];
    }
  }

  size_t bytes() const { return nodes_.size() * sizeof(Node); }

private:
  // Boxes are cut in the middle of their number: 32 levels hold all that can be counted.
  static constexpr int kDeepest = 33;
  struct Node {
    Box box;
    uint32_t second = 0; // the second child; the first one follows
    bool inner = false;
  };

  // A direction of 0 makes infinities, and NaN where o lies in the plane: comparisons with that change nothing.
  static bool passes(const Box &box, const glm::dvec3 &o, const glm::dvec3 &inverse, double end) {
    double begin = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (box.low[axis] - o[axis]) * inverse[axis], b = (box.high[axis] - o[axis]) * inverse[axis];
      const double near = a < b ? a : b, far = a < b ? b : a;
      begin = near > begin ? near : begin;
      end = far < end ? far : end;
    }
    return begin <= end;
  }
  void build(std::vector<Box> &boxes, size_t first, size_t last);

  std::vector<Node> nodes_;
};

} // namespace lancer
