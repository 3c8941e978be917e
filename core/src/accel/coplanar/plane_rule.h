// Which of the faces in one plane is there, and which of them a ray may meet.
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
  // Whether there may be faces that shine where something else is there.
  bool any_hidden_light() const { return hides_light; }
  size_t bytes() const { return faces.bytes(); }

  PlaneOrder order_of(const Hit &hit) const { return plane_order(geometry, rules, hit.instance, hit.primitive); }
  bool emits(const Hit &hit) const { return face_emits(geometry, rules, hit.instance, hit.primitive); }

  // Whether a ray starts at a place of a flagged face where there may be others.
  bool starts_covered(const Ray &ray) const;
  // Whether a ray may end on a flagged face that shines.
  bool may_end_on_light(const Ray &ray) const;

  // All of the following are about hits that are flagged.
  // Whether what a ray meets lies in the plane that it starts in, or ends in: rounding alone holds it before the ray.
  bool starts_in_plane(const Ray &ray, const Hit &hit) const;
  bool ends_in_plane(const Ray &ray, const Hit &hit) const;
  // The last part of a ray, and beyond: what it meets here may lie where it ends.
  static Ray around_end(const Ray &ray);

  // A ray across the plane of a hit that meets whatever may be there in its stead; none where nothing goes before it.
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
  bool shines = false;          // some does
  bool hides_light = false;     // some does that lets light through, and so gives way to others
  bool shines_anywhere = false; // an exact surface does, or there are more planes of light than are worth a look at each
  struct LightPlane {
    glm::dvec3 p, n;
    double reach;
  };
  std::vector<LightPlane> light_planes;
};

} // namespace lancer
