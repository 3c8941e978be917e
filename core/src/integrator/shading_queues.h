// Paths in queues by the code that shades what they have met.
#pragma once

#include "scene/scene.h"

namespace lancer {

class ShadingQueues {
public:
  explicit ShadingQueues(const Scene &scene) : scene_(scene) {
    for (const uint32_t number : scene.classes)
      classes_ = std::max(classes_, number + 1);
    starts_.resize(classes_ + 2);
  }

  // What an instance without slots shows: black.
  static const Material &nothing() {
    static const Material material;
    return material;
  }
  // A path that has met a surface.
  struct Met {
    uint32_t number;
    const Material *material;
  };
  const Material &material(const Hit &hit) const {
    const uint32_t number = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
    return number == kNone ? nothing() : scene_.materials[number];
  }

  void begin() { met_.clear(); }
  size_t size() const { return met_.size(); }
  // number: of the path that has met it.
  void add(size_t number, const Hit &hit) {
    const uint32_t material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
    if (material == kNone)
      met_.push_back({{uint32_t(number), &nothing()}, classes_});
    else
      met_.push_back({{uint32_t(number), &scene_.materials[material]}, scene_.classes[material]});
  }
  // Calls shade(paths) with those of each class, in their order.
  template <class Shade> void each(const Shade &shade) {
    // Count, then place.
    std::fill(starts_.begin(), starts_.end(), 0u);
    for (const Queued &met : met_)
      ++starts_[met.queue + 1];
    for (size_t i = 1; i < starts_.size(); ++i)
      starts_[i] += starts_[i - 1];
    sorted_.resize(met_.size());
    for (const Queued &met : met_)
      sorted_[starts_[met.queue]++] = met.met;
    // Each start has become the end of its queue.
    uint32_t begin = 0;
    for (uint32_t queue = 0; queue <= classes_; ++queue) {
      const uint32_t end = starts_[queue];
      if (end > begin)
        shade(std::span<const Met>(sorted_).subspan(begin, end - begin));
      begin = end;
    }
  }

private:
  struct Queued {
    Met met;
    uint32_t queue;
  };

  const Scene &scene_;
  uint32_t classes_ = 0;
  std::vector<Queued> met_;
  std::vector<uint32_t> starts_;
  std::vector<Met> sorted_;
};

} // namespace lancer
