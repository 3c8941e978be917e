#include "accel/coplanar_accelerator.h"

#include "accel/coplanar_faces.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lancer {

namespace {

class CoplanarAccelerator final : public Accelerator {
public:
  CoplanarAccelerator(std::unique_ptr<Accelerator> a, const Geometry &g, const FaceRounding &r, CoplanarFaces f,
                      std::vector<uint8_t> passing)
      : inner(std::move(a)), geometry(g), rounding(r), faces(std::move(f)), passing_slots(std::move(passing)),
        everything(geometry.instances.size(), 1) {
    for (uint32_t i = 0; i < geometry.instances.size(); ++i) {
      if (!faces.instances[i])
        continue;
      if (geometry.instances[i].kind == ShapeKind::Plane)
        planes.push_back(i);
      else
        widest = std::max(widest, rounding.share(i, glm::dvec3(0.0)));
    }
  }

  TraversalCounts count(std::span<const Ray> rays, bool any) const override { return inner->count(rays, any); }
  size_t bytes() const override { return inner->bytes() + faces.bytes() + everything.capacity(); }
  const char *instruction_set() const override { return inner->instruction_set(); }

private:
  // Whose turn it is to be met.
  using Order = std::tuple<bool, uint32_t, uint32_t, uint32_t>;

  // What is asked, and what of it counts beforehand.
  struct Asked {
    const CoplanarAccelerator &self;
    std::span<const Ray> rays;
    const HitFilter *filter;

    bool counts(size_t ray, const Hit &hit) const {
      return !filter || !filter->instances[hit.instance] || filter->counts(filter->context, ray, hit);
    }
  };

  // A hit of a ray, and the search across its plane for what is there in its stead.
  struct Search {
    size_t ray;
    Hit *hit;
    FlatFace face;
    double reach; // from the start to the plane
    Order best;
    Hit found;
  };
  struct Searches {
    const Asked &asked;
    std::vector<Ray> across;
    std::vector<Search> all;
  };

  void find(std::span<const Ray> rays, std::span<Hit> hits, const HitFilter *filter) const override {
    const Asked asked{*this, rays, filter};
    const std::vector<uint8_t> instances = asked_of(filter);
    const HitFilter counting{instances.data(),
                             [](void *context, size_t ray, const Hit &hit) {
                               const Asked &a = *static_cast<const Asked *>(context);
                               return !a.self.starts_in_plane(a.rays[ray], hit) && a.counts(ray, hit);
                             },
                             const_cast<Asked *>(&asked)};
    inner->closest_hit(rays, hits, counting);
    Searches searches{asked, {}, {}};
    for (size_t i = 0; i < rays.size(); ++i)
      if (hits[i].valid() && faces.has(hits[i].instance, hits[i].primitive))
        search(i, hits[i], searches);
    settle(searches);
  }

  void find(std::span<const Ray> rays, std::span<uint8_t> occluded, const HitFilter *filter) const override {
    const Asked asked{*this, rays, filter};
    const std::vector<uint8_t> instances = asked_of(filter);
    const HitFilter counting{instances.data(),
                             [](void *context, size_t ray, const Hit &hit) {
                               const Asked &a = *static_cast<const Asked *>(context);
                               return a.self.stops(a, ray, hit);
                             },
                             const_cast<Asked *>(&asked)};
    inner->any_hit(rays, occluded, counting);
  }

  // What lets light pass takes none of it where something else is there.
  bool stops(const Asked &asked, size_t ray, const Hit &hit) const {
    if (starts_in_plane(asked.rays[ray], hit))
      return false;
    if (asked.filter && asked.filter->instances[hit.instance] && faces.has(hit.instance, hit.primitive)) {
      Hit there = hit;
      Searches searches{asked, {}, {}};
      search(ray, there, searches);
      settle(searches);
      if (there.instance != hit.instance || there.primitive != hit.primitive)
        return false;
    }
    return asked.counts(ray, hit);
  }

  std::vector<uint8_t> asked_of(const HitFilter *filter) const {
    std::vector<uint8_t> instances = faces.instances;
    for (size_t i = 0; filter && i < instances.size(); ++i)
      instances[i] |= filter->instances[i];
    return instances;
  }

  Order order_of(const Hit &hit) const {
    const Instance &instance = geometry.instances[hit.instance];
    uint32_t slot = 0;
    if (instance.kind == ShapeKind::Mesh && instance.slot_count > 0 && !geometry.meshes[instance.mesh].material_slots.empty())
      slot = std::min<uint32_t>(geometry.meshes[instance.mesh].material_slots[hit.primitive], instance.slot_count - 1);
    const bool passing = instance.slot_count > 0 && !passing_slots.empty() && passing_slots[instance.first_slot + slot] != 0;
    return {passing, hit.instance, slot, hit.primitive};
  }

  // Whether what a ray meets lies in the plane that it starts in: rounding alone holds it before the ray.
  bool starts_in_plane(const Ray &ray, const Hit &hit) const {
    if (ray.skip_instance == kNone || !faces.has(hit.instance, hit.primitive) ||
        !faces.has(ray.skip_instance, ray.skip_primitive))
      return false;
    const std::optional<FlatFace> start = face_left(geometry, ray), end = face_met(geometry, ray, hit);
    if (!start || !end)
      return false;
    const double apart = std::max(rounding.apart(ray.skip_instance, hit.instance, start->n, start->p),
                                  rounding.apart(ray.skip_instance, hit.instance, start->n, end->p));
    if (!parallel(*start, *end, apart))
      return false;
    // The larger one knows the plane better.
    const FlatFace &plane = start->height >= end->height ? *start : *end;
    const glm::dvec3 way = end->p - start->p;
    return std::abs(glm::dot(way, plane.n)) <= apart * (1.0 + glm::length(way) / plane.height);
  }

  // Prepares to look across the plane of a hit.
  void search(size_t number, Hit &hit, Searches &searches) const {
    const Ray &ray = searches.asked.rays[number];
    const Instance &instance = geometry.instances[hit.instance];
    const bool mesh = instance.kind == ShapeKind::Mesh;
    if (mesh && !faces.may_be_covered(hit.instance, hit.primitive, {hit.u, hit.v}))
      return;
    const std::optional<FlatFace> face = face_met(geometry, ray, hit);
    if (!face || (!mesh && !faces.may_be_covered(hit.instance, 0, glm::dvec2(instance.to_object.point(face->p)))))
      return;
    double others = widest;
    for (const uint32_t plane : planes)
      others = std::max(others, rounding.share(plane, face->p));
    const double reach = std::min(rounding.share(hit.instance, face->p) + others, 0x1p-9 * rounding.extent(hit.instance));
    Ray across;
    across.o = face->p - reach * face->n;
    across.d = face->n;
    across.tmax = 2.0 * reach;
    across.kinds = ray.kinds;
    searches.across.push_back(across);
    searches.all.push_back({number, &hit, *face, reach, order_of(hit), hit});
  }

  void settle(Searches &searches) const {
    if (searches.all.empty())
      return;
    std::vector<uint8_t> nothing(searches.all.size());
    const HitFilter looking{everything.data(),
                            [](void *context, size_t i, const Hit &hit) {
                              Searches &s = *static_cast<Searches *>(context);
                              s.asked.self.look_at(s, i, hit);
                              return false;
                            },
                            &searches};
    inner->any_hit(searches.across, nothing, looking);
    for (const Search &s : searches.all)
      *s.hit = s.found;
  }

  void look_at(Searches &searches, size_t number, const Hit &hit) const {
    Search &s = searches.all[number];
    const Ray &ray = searches.asked.rays[s.ray];
    if (!faces.has(hit.instance, hit.primitive) || (ray.skip_instance == hit.instance && ray.skip_primitive == hit.primitive))
      return;
    const Order order = order_of(hit);
    if (!(order < s.best))
      return;
    const std::optional<FlatFace> face = face_met(geometry, searches.across[number], hit);
    const double apart = rounding.apart(s.hit->instance, hit.instance, s.face.n, s.face.p);
    if (!face || std::abs(hit.t - s.reach) > apart || !parallel(s.face, *face, apart))
      return;
    const Hit there{s.hit->t, hit.u, hit.v, hit.instance, hit.primitive};
    if (!searches.asked.counts(s.ray, there))
      return;
    s.best = order;
    s.found = there;
  }

  const std::unique_ptr<Accelerator> inner;
  const Geometry &geometry;
  const FaceRounding rounding;
  const CoplanarFaces faces;
  const std::vector<uint8_t> passing_slots;
  const std::vector<uint8_t> everything; // by instance: ask about its hits
  std::vector<uint32_t> planes;          // instances without end
  double widest = 0.0;                   // of the others, how much each may be off
};

} // namespace

std::unique_ptr<Accelerator> build_accelerator(AcceleratorKind kind, const Geometry &geometry, PlaneRules rules,
                                               const BuildContext &context) {
  std::unique_ptr<Accelerator> plain = build_accelerator(kind, geometry, context);
  const FaceRounding rounding(geometry, rules.origin);
  CoplanarFaces faces = find_coplanar_faces(geometry, rounding, context);
  if (!faces.any())
    return plain;
  return std::make_unique<CoplanarAccelerator>(std::move(plain), geometry, rounding, std::move(faces),
                                               std::move(rules.passing_slots));
}

} // namespace lancer
