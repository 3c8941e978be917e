#include "lights/light_finder.h"

#include <algorithm>

namespace lancer {

namespace {

// What double may lose on the way through a scene about 1024 wide, with much room.
constexpr double kPad = 0x1p-36;

} // namespace

LightFinder::LightFinder(std::vector<Box> boxes) {
  for (Box &box : boxes) {
    const glm::dvec3 size = glm::abs(box.low) + glm::abs(box.high);
    const double pad = kPad * (1024.0 + size.x + size.y + size.z);
    box.low -= pad;
    box.high += pad;
  }
  if (!boxes.empty())
    build(boxes, 0, boxes.size());
}

void LightFinder::build(std::vector<Box> &boxes, size_t first, size_t last) {
  const size_t number = nodes_.size();
  nodes_.emplace_back();
  Box whole = boxes[first];
  for (size_t i = first; i < last; ++i) {
    whole.low = glm::min(whole.low, boxes[i].low);
    whole.high = glm::max(whole.high, boxes[i].high);
  }
  nodes_[number].box = whole;
  if (last - first == 1)
    return;
  // Cut along the longest side.
  const glm::dvec3 size = whole.high - whole.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const size_t middle = first + (last - first) / 2;
  std::nth_element(boxes.begin() + long(first), boxes.begin() + long(middle), boxes.begin() + long(last),
                   [axis](const Box &a, const Box &b) {
                     const double x = a.low[axis] + a.high[axis], y = b.low[axis] + b.high[axis];
                     return x < y || (x == y && a.light < b.light);
                   });
  build(boxes, first, middle);
  nodes_[number].inner = true;
  nodes_[number].second = uint32_t(nodes_.size());
  build(boxes, middle, last);
}

} // namespace lancer
