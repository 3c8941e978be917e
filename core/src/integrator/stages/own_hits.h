// Hits of rays with one instance each, as if there were no other.
//
// In: rays and their instances, from walks below surfaces and from nodes. Out: their hits, without the order of coplanar faces,
// which would let other instances hide the ray's own. Rays are in the normalised world. Callers: the stages walk, profile and
// node rays.
#pragma once

#include "compile/scene.h"

#include <span>
#include <vector>

namespace lancer {

class OwnHits final : HitFilter {
public:
  explicit OwnHits(const Scene &scene);

  // of: the instance of each ray.
  void closest(std::span<const Ray> rays, std::span<const uint32_t> of, std::span<Hit> hits);
  void any(std::span<const Ray> rays, std::span<const uint32_t> of, std::span<uint8_t> occluded);
  // Finds all hits of each ray, which hits_of() returns until the next call.
  void all(std::span<const Ray> rays, std::span<const uint32_t> of);
  // Returns the hits of a ray in their order on the ray, those at one distance as one: the faces of an edge.
  std::span<const Hit> hits_of(size_t ray) const {
    return std::span(hits_).subspan(first_[ray], first_[ray + 1] - first_[ray]);
  }

private:
  // Whether a hit belongs to the ray's instance; collects it, and lets the ray go on, where all hits are wanted.
  bool counts(size_t ray, const Hit &hit) override;

  struct Found {
    size_t ray;
    Hit hit;
  };

  const Accelerator &alone_;
  std::vector<uint8_t> asked_; // HitFilter::instances: all
  std::span<const uint32_t> instance_of_;
  bool collects_ = false;
  std::vector<Found> found_;
  std::vector<uint8_t> occluded_;
  std::vector<Hit> hits_;
  std::vector<size_t> first_; // by ray: of its hits
};

} // namespace lancer
