// Queues of paths by the shading code of the surfaces that they have hit, so that neighbouring vertices run the same code: by
// classes of materials, whose lobes differ in numbers alone and whose programs of nodes are the same.
//
// In: numbers of rays and their hits, from an integrator. Out: the numbers of each class of materials, for the integrator.
// Callers: all integrators.
#pragma once

#include "compile/scene.h"

#include <algorithm>
#include <numeric>

namespace lancer {

class ShadingQueues {
public:
  explicit ShadingQueues(const Scene &scene) : scene_(scene), places_(scene.classes.size()), order_(scene.classes.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::ranges::stable_sort(order_, {}, [&](uint32_t material) { return scene.classes[material]; });
    for (uint32_t place = 0; place < order_.size(); ++place)
      places_[order_[place]] = place;
    starts_.resize(order_.size() + 2);
  }

  // Returns the material of an instance without slots: black.
  static const MaterialView &nothing() {
    static const MaterialView material;
    return material;
  }
  // A ray that has hit a surface.
  struct Queued {
    uint32_t number;
    const MaterialView *material;
  };
  const MaterialView &material(const Hit &hit) const {
    const uint32_t number = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
    return number == kNone ? nothing() : scene_.materials[number];
  }

  void begin() { met_.clear(); }
  size_t size() const { return met_.size(); }
  // Adds a hit; number: of its ray.
  void add(size_t number, const Hit &hit) {
    const uint32_t material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
    if (material == kNone)
      met_.push_back({{uint32_t(number), &nothing()}, uint32_t(order_.size())});
    else
      met_.push_back({{uint32_t(number), &scene_.materials[material]}, places_[material]});
  }
  // Calls shade(paths) with the paths of each class, one material after the other.
  template <class Shade> void each(const Shade &shade) {
    // Count, then place.
    std::fill(starts_.begin(), starts_.end(), 0u);
    for (const Entry &met : met_)
      ++starts_[met.place + 1];
    for (size_t i = 1; i < starts_.size(); ++i)
      starts_[i] += starts_[i - 1];
    sorted_.resize(met_.size());
    for (const Entry &met : met_)
      sorted_[starts_[met.place]++] = met.met;
    // Each start has become the end of its material.
    uint32_t begin = 0;
    for (size_t place = 0; place <= order_.size(); ++place) {
      const bool more = place + 1 < order_.size() && scene_.classes[order_[place + 1]] == scene_.classes[order_[place]];
      const uint32_t end = starts_[place];
      if (more || end == begin)
        continue;
      shade(std::span<const Queued>(sorted_).subspan(begin, end - begin));
      begin = end;
    }
  }

private:
  struct Entry {
    Queued met;
    uint32_t place;
  };

  const Scene &scene_;
  std::vector<uint32_t> places_; // of each material in the order by classes
  std::vector<uint32_t> order_;  // the materials in that order
  std::vector<Entry> met_;
  std::vector<uint32_t> starts_;
  std::vector<Queued> sorted_;
};

} // namespace lancer
