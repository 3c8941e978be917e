// The priority order applied to rays: decides which of the coplanar faces at a place a ray hits or skips.
#pragma once

#include "accel/coplanar/coplanar_faces.h"

namespace lancer {

class PlaneRule {
public:
  PlaneRule(const Geometry &geometry, const FaceRounding &rounding, CoplanarFaces faces, PlaneRules rules);

  bool flagged(const Hit &hit) const { return faces.has(hit.instance, hit.primitive); }
  // Tests the face that a ray starts on.
  bool flagged(const Ray &ray) const { return ray.skip_instance != kNone && faces.has(ray.skip_instance, ray.skip_primitive); }
  // By instance: 1 if some of its faces are flagged.
  const std::vector<uint8_t> &instances() const { return faces.instances; }
  // Returns whether faces of higher priority may cover emitting ones.
  bool any_hidden_light() const { return hides_light; }
  size_t bytes() const { return faces.bytes(); }

  PlaneOrder order_of(const Hit &hit) const { return plane_order(geometry, rules, hit.instance, hit.primitive); }
  bool emits(const Hit &hit) const { return face_emits(geometry, rules, hit.instance, hit.primitive); }

  // Returns whether a ray starts on a flagged face at a place that other faces may cover.
  bool starts_covered(const Ray &ray) const;
  // Returns whether a ray may end on a flagged face that emits.
  bool may_end_on_light(const Ray &ray) const;

  // The hits passed to the following functions must be flagged. Return whether a hit lies in the plane that the ray starts or
  // ends in, so that only rounding puts it on the ray.
  bool starts_in_plane(const Ray &ray, const Hit &hit) const;
  bool ends_in_plane(const Ray &ray, const Hit &hit) const;
  // Returns a ray along the last part of the given ray and somewhat beyond; its hits may lie at the given ray's end.
  static Ray around_end(const Ray &ray);

  // A ray across the plane of a hit that finds faces of possibly higher priority; none if there cannot be any.
  struct Across {
    Ray ray;
    FlatFace face;
    double reach; // distance from its origin to the plane
  };
  std::optional<Across> across(const Ray &ray, const Hit &hit) const;
  // Returns whether a hit of that ray is in the plane of the original hit.
  bool in_plane(const Across &across, const Hit &hit, const Hit &met) const;

private:
  double others(const glm::dvec3 &p) const;
  void find_light_planes();

  const Geometry &geometry;
  const FaceRounding rounding;
  const CoplanarFaces faces;
  const PlaneRules rules;
  std::vector<uint32_t> planes; // infinite planes that have such faces
  double widest = 0.0;          // largest rounding share of the other instances
  // Facts about the instances that have such faces:
  bool shines = false;          // one emits
  bool hides_light = false;     // one emits and is transparent, so that it has lower priority
  bool shines_anywhere = false; // an exact surface emits, or more planes emit than are worth a test each
  struct LightPlane {
    glm::dvec3 p, n;
    double reach;
  };
  std::vector<LightPlane> light_planes;
};

} // namespace lancer
