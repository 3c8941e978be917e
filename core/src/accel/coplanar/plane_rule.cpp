#include "accel/coplanar/coplanar_faces.h"

#include <algorithm>
#include <cmath>

namespace lancer {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEnd = 0x1p-8;
constexpr size_t kLightPlanes = 16;

uint32_t slot_of(const GeometryView &geometry, uint32_t number, uint32_t primitive) {
  const Instance &instance = geometry.instances[number];
  if (instance.kind != ShapeKind::Mesh || instance.slot_count == 0 || geometry.meshes[instance.mesh].material_slots.empty())
    return 0;
  return std::min<uint32_t>(geometry.meshes[instance.mesh].material_slots[primitive], instance.slot_count - 1);
}

bool is(const GeometryView &geometry, const std::vector<uint8_t> &slots, uint32_t number, uint32_t primitive) {
  const Instance &instance = geometry.instances[number];
  return instance.slot_count > 0 && !slots.empty() && slots[instance.first_slot + slot_of(geometry, number, primitive)] != 0;
}

} // namespace

PlaneOrder plane_order(const GeometryView &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive) {
  return {is(geometry, rules.see_through_slots, instance, primitive), !face_emits(geometry, rules, instance, primitive),
          instance, slot_of(geometry, instance, primitive), primitive};
}

bool face_emits(const GeometryView &geometry, const PlaneRules &rules, uint32_t instance, uint32_t primitive) {
  return is(geometry, rules.emitting_slots, instance, primitive);
}

PlaneRule::PlaneRule(const GeometryView &g, const FaceRounding &r, CoplanarFaces f, PlaneRules known)
    : geometry(g), rounding(r), faces(std::move(f)), rules(std::move(known)) {
  for (uint32_t i = 0; i < geometry.instances.size(); ++i) {
    if (!faces.instances[i])
      continue;
    const Instance &instance = geometry.instances[i];
    for (uint32_t slot = instance.first_slot; slot < instance.first_slot + instance.slot_count; ++slot) {
      const bool emits = !rules.emitting_slots.empty() && rules.emitting_slots[slot];
      shines = shines || emits;
      hides_light = hides_light || (emits && !rules.see_through_slots.empty() && rules.see_through_slots[slot]);
    }
    if (instance.kind == ShapeKind::Plane)
      planes.push_back(i);
    else
      widest = std::max(widest, rounding.share(i, glm::dvec3(0.0)));
  }
  if (shines)
    find_light_planes();
}

void PlaneRule::find_light_planes() {
  for (uint32_t i = 0; i < geometry.instances.size(); ++i) {
    if (!faces.instances[i])
      continue;
    const Instance &instance = geometry.instances[i];
    const bool mesh = instance.kind == ShapeKind::Mesh;
    const size_t count = mesh ? geometry.meshes[instance.mesh].triangles.size() : 1;
    for (uint32_t primitive = 0; primitive < count && !shines_anywhere; ++primitive) {
      const Hit hit{0.0, 0.0f, 0.0f, i, primitive};
      if (!flagged(hit) || !emits(hit))
        continue;
      // Test each triangle separately: outside a triangle, its plane is less precise.
      shines_anywhere = !mesh || light_planes.size() == kLightPlanes;
      if (shines_anywhere)
        return;
      glm::dvec3 corner[3];
      world_corners(geometry, i, primitive, corner);
      const FlatFace face = triangle_face(corner);
      light_planes.push_back({face.p, face.n, 2.0 * (rounding.share(i, face.p) + others(face.p))});
    }
  }
}

bool PlaneRule::starts_covered(const Ray &ray) const {
  return flagged(ray) && faces.may_be_covered(ray.skip_instance, ray.skip_primitive, ray.o);
}

bool PlaneRule::may_end_on_light(const Ray &ray) const {
  if (!shines || !(ray.tmax < kInfinity))
    return false;
  const glm::dvec3 end = ray.o + ray.tmax * ray.d;
  return shines_anywhere || std::any_of(light_planes.begin(), light_planes.end(), [&](const LightPlane &plane) {
           return std::abs(glm::dot(end - plane.p, plane.n)) <= plane.reach;
         });
}

bool PlaneRule::starts_in_plane(const Ray &ray, const Hit &hit) const {
  if (!flagged(ray))
    return false;
  const std::optional<FlatFace> start = face_left(geometry, ray), end = face_met(geometry, ray, hit);
  if (!start || !end)
    return false;
  const double apart = std::max(rounding.apart(ray.skip_instance, hit.instance, start->n, start->p),
                                rounding.apart(ray.skip_instance, hit.instance, start->n, end->p));
  if (!parallel(*start, *end, apart))
    return false;
  // The larger face has the more precise plane.
  const FlatFace &plane = start->height >= end->height ? *start : *end;
  const glm::dvec3 way = end->p - start->p;
  return std::abs(glm::dot(way, plane.n)) <= apart * (1.0 + glm::length(way) / plane.height);
}

bool PlaneRule::ends_in_plane(const Ray &ray, const Hit &hit) const {
  if (!(ray.tmax < kInfinity && hit.t > (1.0 - kEnd) * ray.tmax))
    return false;
  const std::optional<FlatFace> face = face_met(geometry, ray, hit);
  return face && std::abs(glm::dot(ray.o + ray.tmax * ray.d - face->p, face->n)) <=
                     rounding.share(hit.instance, face->p) + others(face->p);
}

Ray PlaneRule::around_end(const Ray &ray) {
  Ray around = ray;
  around.tmin = (1.0 - kEnd) * ray.tmax;
  around.tmax = (1.0 + kEnd) * ray.tmax;
  return around;
}

// Returns the largest share of any face at p in the distance between coplanar faces.
double PlaneRule::others(const glm::dvec3 &p) const {
  double most = widest;
  for (const uint32_t plane : planes)
    most = std::max(most, rounding.share(plane, p));
  return most;
}

std::optional<PlaneRule::Across> PlaneRule::across(const Ray &ray, const Hit &hit) const {
  const Instance &instance = geometry.instances[hit.instance];
  const bool mesh = instance.kind == ShapeKind::Mesh;
  if (mesh && !faces.may_lose(hit.instance, hit.primitive, glm::dvec2(hit.u, hit.v)))
    return {};
  const std::optional<FlatFace> face = face_met(geometry, ray, hit);
  if (!face || (!mesh && !faces.may_lose(hit.instance, 0, face->p)))
    return {};
  Across across{{}, *face, rounding.most(hit.instance, rounding.share(hit.instance, face->p) + others(face->p))};
  across.ray.o = face->p - across.reach * face->n;
  across.ray.d = face->n;
  across.ray.tmax = 2.0 * across.reach;
  across.ray.kinds = ray.kinds;
  return across;
}

bool PlaneRule::in_plane(const Across &across, const Hit &hit, const Hit &met) const {
  if (!flagged(met))
    return false;
  const std::optional<FlatFace> face = face_met(geometry, across.ray, met);
  const double apart = rounding.apart(hit.instance, met.instance, across.face.n, across.face.p);
  return face && std::abs(met.t - across.reach) <= apart && parallel(across.face, *face, apart);
}

} // namespace lancer
