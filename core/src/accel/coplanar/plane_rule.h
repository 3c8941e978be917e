// The priority order as rays ask for it: which of the coplanar faces at a place a ray meets, and which it leaves out.
#pragma once

#include "accel/coplanar/coplanar_faces.h"

namespace lancer {

class PlaneRule {
public:
  PlaneRule(const Geometry &geometry, const FaceRounding &rounding, CoplanarFaces faces, PlaneRules rules);

  bool flagged(const Hit &hit) const { return faces.has(hit.instance, hit.primitive); }
  // By the face that a ray starts on.
  bool flagged(const Ray &ray) const { return ray.skip_instance != kNone && faces.has(ray.skip_instance, ray.skip_primitive); }
  // By instance: 1 where some faces are.
  const std::vector<uint8_t> &instances() const { return faces.instances; }
  // Whether faces of higher priority may cover some that emit.
  bool any_hidden_light() const { return hides_light; }
  size_t bytes() const { return faces.bytes(); }

  PlaneOrder order_of(const Hit &hit) const { return plane_order(geometry, rules, hit.instance, hit.primitive); }
  bool emits(const Hit &hit) const { return face_emits(geometry, rules, hit.instance, hit.primitive); }

  // Whether a ray starts at a place of a flagged face where there may be others.
  bool starts_covered(const Ray &ray) const;
  // Whether a ray may end on a flagged face that emits.
  bool may_end_on_light(const Ray &ray) const;

  // All of the following are about hits that are flagged.
  // Whether a hit lies in the plane that the ray starts in, or ends in, so that rounding alone puts it on the ray's way.
  bool starts_in_plane(const Ray &ray, const Hit &hit) const;
  bool ends_in_plane(const Ray &ray, const Hit &hit) const;
  // The last part of a ray, and beyond: what it meets here may lie where it ends.
  static Ray around_end(const Ray &ray);

  // A ray across the plane of a hit, which finds the faces that may have the higher priority; none where there are none.
  struct Across {
    Ray ray;
    FlatFace face;
    double reach; // from its start to the plane
  };
  std::optional<Across> across(const Ray &ray, const Hit &hit) const;
  // Whether what that meets is in the plane of the hit.
  bool in_plane(const Across &across, const Hit &hit, const Hit &met) const;

private:
  double others(const glm::dvec3 &p) const;
  void find_light_planes();

  const Geometry &geometry;
  const FaceRounding rounding;
  const CoplanarFaces faces;
  const PlaneRules rules;
  std::vector<uint32_t> planes; // instances without end that have such faces
  double widest = 0.0;          // of the others, how much each may be off
  // Of the instances that have such faces:
  bool shines = false;          // one emits
  bool hides_light = false;     // one emits and lets light through, and so has the lower priority
  bool shines_anywhere = false; // an exact surface emits, or more planes do than are worth a test each
  struct LightPlane {
    glm::dvec3 p, n;
    double reach;
  };
  std::vector<LightPlane> light_planes;
};

} // namespace lancer
