// Light of the rays of a batch that is found in any order of rays and added up in theirs.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lancer {

class LightByRay {
public:
  void begin(size_t rays) {
    found_.clear();
    ends_.assign(rays + 1, 0u);
  }
  void add(uint32_t ray, const glm::vec3 &light) {
    found_.push_back({ray, light});
    ++ends_[ray + 1];
  }
  // After the last.
  void sort() {
    for (size_t i = 1; i < ends_.size(); ++i)
      ends_[i] += ends_[i - 1];
    sorted_.resize(found_.size());
    // The start of each becomes its end.
    for (const Found &found : found_)
      sorted_[ends_[found.ray]++] = found.light;
  }
  // What was added for a ray, in that order.
  std::span<const glm::vec3> of(size_t ray) const {
    const uint32_t begin = ray == 0 ? 0 : ends_[ray - 1];
    return std::span(sorted_).subspan(begin, ends_[ray] - begin);
  }
  bool empty() const { return found_.empty(); }

private:
  struct Found {
    uint32_t ray;
    glm::vec3 light;
  };

  std::vector<Found> found_;
  std::vector<uint32_t> ends_;
  std::vector<glm::vec3> sorted_;
};

} // namespace lancer
